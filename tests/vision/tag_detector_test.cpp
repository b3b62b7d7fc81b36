// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/tag_detector.h"

#include "core/random.h"
#include "tests/effort.h"
#include "tests/vision/rendered_tag.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace fidservo::vision {
namespace {

using testing::corners_of;
using testing::render;
using testing::RenderedTag;

TEST(TagDetector, RenderedTag_HasItsCornersInPlateOrderWithPixelCentresAtIntegers) {
    for (const double angle : {0.0, 0.6}) {
        const RenderedTag tag{12, {320.25, 240.5}, 250.0, angle};
        const std::vector<TagDetection> found = TagDetector().detect(render({tag}, {}), 42);
        ASSERT_EQ(found.size(), 1U);
        EXPECT_EQ(found[0].tag_id, 12);
        EXPECT_EQ(found[0].time_ns, 42);
        EXPECT_EQ(found[0].corrected_bits, 0);
        EXPECT_GT(found[0].decision_margin, 50.0);
        for (std::size_t k = 0; k < 4; ++k)
            EXPECT_LT((found[0].corners_px[k] - corners_of(tag)[k]).norm(), 0.3) << "corner " << k;
    }
}

TEST(TagDetector, EveryFourthCode_IsReadAsItself) {
    TagDetector detector;
    for (int id = 0; id < 587; id += 4) {
        const std::vector<TagDetection> found =
            detector.detect(render({{id, {80, 80}, 80.0}}, {{160, 160}}), 0);
        ASSERT_EQ(found.size(), 1U) << id;
        EXPECT_EQ(found[0].tag_id, id);
    }
}

TEST(TagDetector, LargeImage_IsSearchedWhereItHasEdges) {
    const std::vector<RenderedTag> tags{{7, {150, 120}, 80.0}, {8, {380, 150}, 18.0, 0.3}};
    const cv::Mat small = render(tags, {.size_px = {480, 270}, .noise = false});
    cv::Mat large(6000, 8000, CV_8UC1, cv::Scalar(small.at<unsigned char>(0, 0)));
    const cv::Point at(5604, 3020);
    small.copyTo(large(cv::Rect(at, small.size())));
    for (TagDetectorOptions options : {machine_camera_options(), thorough_options()}) {
        TagDetector detector(options);
        EXPECT_TRUE(detector.detect(cv::Mat(6000, 8000, CV_8UC1, cv::Scalar(200)), 0).empty());
        const std::vector<TagDetection> alone = detector.detect(small, 0), found = detector.detect(large, 0);
        ASSERT_EQ(alone.size(), tags.size());
        ASSERT_EQ(found.size(), alone.size());
        for (std::size_t k = 0; k < found.size(); ++k) {
            EXPECT_EQ(found[k].tag_id, alone[k].tag_id);
            for (std::size_t c = 0; c < 4; ++c)
                EXPECT_LT(
                    (found[k].corners_px[c] - Eigen::Vector2d(at.x, at.y) - alone[k].corners_px[c]).norm(),
                    1e-3);
        }
    }
}

TEST(TagDetector, SameIdTwice_GivesBothFromLeftToRight) {
    const cv::Mat image =
        render({{5, {480, 240}, 150.0}, {5, {160, 240}, 150.0}, {2, {320, 100}, 100.0}}, {});
    const std::vector<TagDetection> found = TagDetector().detect(image, 0);
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(found[0].tag_id, 2);
    EXPECT_EQ(found[1].tag_id, 5);
    EXPECT_EQ(found[2].tag_id, 5);
    EXPECT_LT(found[1].corners_px[0].x(), found[2].corners_px[0].x());
}

TEST(TagDetector, Region_LimitsTheSearchAndKeepsTheImagesCoordinates) {
    const RenderedTag left{5, {160, 240}, 150.0};
    const cv::Mat image = render({left, {6, {480, 240}, 150.0}}, {});
    TagDetector detector;
    const std::vector<TagDetection> found = detector.detect(image, 0, {-20, 100, 340, 300});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].tag_id, 5);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_LT((found[0].corners_px[k] - corners_of(left)[k]).norm(), 0.2);
}

TEST(TagDetector, EmptyOrTinyImage_HoldsNoTag) {
    TagDetector detector(thorough_options());
    EXPECT_TRUE(detector.detect(cv::Mat1b(), 0).empty());
    EXPECT_TRUE(detector.detect(cv::Mat1b(3, 300, std::uint8_t{0}), 0).empty());
    EXPECT_TRUE(detector.detect(cv::Mat1b(100, 100, std::uint8_t{90}), 0).empty());
}

TEST(TagDetector, Image_IsNotModified) {
    const cv::Mat image = render({{1}}, {});
    const cv::Mat before = image.clone();
    TagDetector().detect(image, 0);
    TagDetector(thorough_options()).detect(image, 0);
    EXPECT_EQ(cv::norm(image, before, cv::NORM_INF), 0.0);
}

TEST(SlowTagDetector, ThoroughOptions_ReadTagsWithOneAndAHalfPixelsABit) {
    int found_by_both = 0;
    int found = 0;
    for (int id = 0; id < 20; ++id) {
        testing::Rendering how{{64, 64}, 0.5};
        how.seed = id;
        const cv::Mat image = render({{id, {31.3 + 0.1 * id, 32.1}, 12.0, 0.1}}, how);
        found += static_cast<int>(TagDetector(thorough_options()).detect(image, 0).size());
        found_by_both += static_cast<int>(TagDetector().detect(image, 0).size());
    }
    EXPECT_GE(found, 18);
    EXPECT_LT(found_by_both, found);
}

/// Textures without a tag: white noise, noise at several scales, random checkers (the worst: their bits are
/// as sharp as a tag's).
cv::Mat texture(int kind, std::uint64_t seed) {
    NoiseStream random(seed, "texture");
    cv::Mat1f field(480, 640);
    constexpr std::array<double, 5> blur_px{0.0, 0.7, 1.2, 2.0, 4.0};
    constexpr std::array<int, 3> checker_px{3, 5, 8};
    if (kind < 5) {
        for (float& value : field) value = static_cast<float>(random.normal());
        if (blur_px[kind] > 0) cv::GaussianBlur(field, field, {}, blur_px[kind]);
        cv::Scalar mean;
        cv::Scalar deviation;
        cv::meanStdDev(field, mean, deviation);
        field *= 60.0 / deviation[0];
        field += 128.0;
    } else {
        const int size = checker_px[kind - 5];
        cv::Mat1f cells(480 / size + 1, 640 / size + 1);
        for (float& value : cells) value = random.uniform() < 0.5 ? 30.0F : 220.0F;
        cv::Mat1f enlarged;
        cv::resize(cells, enlarged, {}, size, size, cv::INTER_NEAREST);
        cv::GaussianBlur(enlarged(cv::Rect(0, 0, 640, 480)), field, {}, 0.7);
    }
    cv::Mat1b image;
    field.convertTo(image, CV_8U);
    return image;
}

void expect_no_tag(int images) {
    TagDetector detector(thorough_options());
    for (int k = 0; k < images; ++k)
        EXPECT_TRUE(detector.detect(texture(k % 8, k), 0).empty()) << "kind " << k % 8 << " seed " << k;
}

TEST(TagDetector, Texture_HoldsNoTag) {
    expect_no_tag(8);
}
TEST(SlowTagDetector, MuchTexture_HoldsNoTag) {
    expect_no_tag(fidservo::testing::draws(240, 72));
}

}  // namespace
}  // namespace fidservo::vision
