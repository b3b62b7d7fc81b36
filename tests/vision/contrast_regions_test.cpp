// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/contrast_regions.h"

#include "core/random.h"
#include "tests/vision/quick_tag.h"
#include "vision/tags/tag_detector.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace fidservo::vision {
namespace {

using testing::cells_of;
using testing::draw;
using testing::QuickTag;

TEST(ContrastRegions, BlankImages_HaveNone) {
    EXPECT_TRUE(contrast_regions(cv::Mat(), 30).empty());
    EXPECT_TRUE(contrast_regions(draw({}, {}), 30).empty());
}

TEST(ContrastRegions, OneDarkPixel_IsInsideABoxOnTheGrid) {
    cv::Mat image(97, 131, CV_8UC1, cv::Scalar(200));
    for (const cv::Point at : {cv::Point(0, 0), cv::Point(130, 96), cv::Point(60, 50), cv::Point(130, 0)}) {
        image.at<unsigned char>(at) = 171;
        EXPECT_TRUE(contrast_regions(image, 30).empty()) << at;
        image.at<unsigned char>(at) = 170;
        const auto regions = contrast_regions(image, 30);
        ASSERT_EQ(regions.size(), 1U) << at;
        EXPECT_TRUE(regions[0].contains(at)) << at;
        EXPECT_EQ(regions[0].x % 4 + regions[0].y % 4, 0) << at;
        EXPECT_EQ(regions[0] & cv::Rect(0, 0, 131, 97), regions[0]) << at;
        image.at<unsigned char>(at) = 200;
    }
}

TEST(ContrastBox, HoldsAllRegionsAndNoMore) {
    EXPECT_TRUE(contrast_box(cv::Mat(), 30).empty());
    EXPECT_TRUE(contrast_box(draw({}, {}), 30).empty());
    cv::Mat image(97, 131, CV_8UC1, cv::Scalar(200));
    image.at<unsigned char>(40, 60) = 171;
    EXPECT_TRUE(contrast_box(image, 30).empty());
    image.at<unsigned char>(40, 60) = 170;
    EXPECT_EQ(contrast_box(image, 30), contrast_regions(image, 30).front());
    image.at<unsigned char>(96, 130) = 170;
    const cv::Rect box = contrast_box(image, 30);
    for (const cv::Rect& region : contrast_regions(image, 30)) EXPECT_EQ(region & box, region);
    EXPECT_EQ(box.br(), cv::Point(131, 97));
    EXPECT_EQ(box.x % 4 + box.y % 4, 0);
    EXPECT_GT(box.x, 0);
}

TEST(ContrastRegions, TagsFarApart_HaveABoxEachWithTheirQuietZones) {
    const cv::Mat image = draw({{cells_of(1), {120.0, 100.0}, 80.0}, {cells_of(2), {420.0, 100.0}, 80.0}},
                               {.size_px = {560, 200}});
    const auto regions = contrast_regions(image, 30);
    ASSERT_EQ(regions.size(), 2U);
    EXPECT_EQ(regions[0] & cv::Rect(70, 50, 100, 100), cv::Rect(70, 50, 100, 100));
    EXPECT_EQ(regions[1] & cv::Rect(370, 50, 100, 100), cv::Rect(370, 50, 100, 100));
    EXPECT_LT(regions[0].area() + regions[1].area(), image.cols * image.rows / 3);
}

TEST(ContrastRegions, SearchedOneByOne_GiveTheTagsOfTheWholeImage) {
    constexpr std::uint64_t seed = 41;
    NoiseStream random(seed, "plates");
    const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    TagDetector detector;
    std::size_t tags = 0;
    for (int k = 0; k < 60; ++k) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << ", picture " << k);
        std::vector<QuickTag> printed;
        printed.reserve(3);
        for (int column = 0; column < 3; ++column)
            printed.push_back({cells_of(static_cast<int>(between(0, 587))),
                               {60.0 + 200.0 * column + between(-50, 50), between(40, 160)},
                               between(30, 110),
                               between(-3.1, 3.1),
                               between(20, 150)});
        cv::Mat image = draw(printed, {.size_px = {523, 199}, .seed = seed + k});
        cv::line(image, {static_cast<int>(between(0, 523)), 0}, {static_cast<int>(between(0, 523)), 198}, 90,
                 2);
        const auto whole = detector.detect(image, k);
        std::vector<TagDetection> parts;
        for (const cv::Rect& region : contrast_regions(image, machine_camera_options().min_contrast)) {
            const auto found = detector.detect(image, k, region);
            parts.insert(parts.end(), found.begin(), found.end());
        }
        std::sort(parts.begin(), parts.end(), by_id_from_left);
        ASSERT_EQ(parts.size(), whole.size());
        tags += whole.size();
        for (std::size_t i = 0; i < whole.size(); ++i) {
            EXPECT_EQ(parts[i].tag_id, whole[i].tag_id);
            // The library computes in single precision from the region's corner: its own 0.2 px are the
            // limit.
            for (std::size_t c = 0; c < 4; ++c)
                EXPECT_LT((parts[i].corners_px[c] - whole[i].corners_px[c]).norm(), 0.2);
        }
    }
    EXPECT_GT(tags, 60U);
}

}  // namespace
}  // namespace fidservo::vision
