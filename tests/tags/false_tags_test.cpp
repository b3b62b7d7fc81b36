// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures without the tags that are looked for.
#include "tests/effort.h"
#include "tests/tags/drawn_tag.h"
#include "vision/tags/tag_detector.h"
#include "vision/tags/tag_pattern.h"

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace fidservo::vision {
namespace {

/// White noise, noise at several scales, and checkers at random, whose cells are as sharp as a tag's.
cv::Mat1b texture(int kind, std::mt19937_64& random) {
    constexpr std::array<double, 5> blur_px{0.0, 0.7, 1.2, 2.0, 4.0};
    constexpr std::array<int, 3> checker_px{3, 5, 8};
    const cv::Size size(640, 480);
    cv::Mat1f field(size);
    std::normal_distribution<float> normal(0.0F, 1.0F);
    if (kind < 5) {
        for (float& value : field) value = normal(random);
        if (blur_px.at(static_cast<std::size_t>(kind)) > 0.0)
            cv::GaussianBlur(field, field, {}, blur_px.at(static_cast<std::size_t>(kind)));
        cv::Scalar mean, deviation;
        cv::meanStdDev(field, mean, deviation);
        field = field * (60.0 / deviation[0]) + 128.0;
    } else {
        const int px = checker_px.at(static_cast<std::size_t>(kind - 5));
        cv::Mat1f cells(size.height / px + 1, size.width / px + 1), enlarged;
        for (float& value : cells) value = normal(random) < 0.0F ? 30.0F : 220.0F;
        cv::resize(cells, enlarged, {}, px, px, cv::INTER_NEAREST);
        cv::GaussianBlur(enlarged(cv::Rect({0, 0}, size)), field, {}, 0.7);
    }
    cv::Mat1b image;
    field.convertTo(image, CV_8U);
    return image;
}

std::size_t expect_nothing(const cv::Mat& image, const TagReading& reading, const std::string& what) {
    std::size_t tags = 0;
    for (const TagDetection& tag : TagDetector(thorough_options(reading)).detect(image, 0)) {
        ++tags;
        ADD_FAILURE() << what << ": " << (reading.mirrored ? "mirrored " : "") << text_of(reading.print)
                      << " " << tag.tag_id << ", explained "
                      << explained_contrast(image, tag.corners_px, tag_pattern(reading.print, tag.tag_id));
    }
    return tags;
}

TEST(LeastExplained, OfEveryFamily_IsHigherForSmallerCodesInLargerBooks) {
    for (const TagFamily& family : tag_families())
        fmt::print(
            "{}: {} codes {} bits apart, {} corrected, explained at least {:.3f}, of the code {:.3f}\n",
            family.name, family.size(), family.least_distance, most_correctable_bits(family),
            least_explained(family).of_tag, least_explained(family).of_code);
    EXPECT_EQ(least_explained(usual_tag_family()).of_tag, 0.4);
    const auto level = [](const char* name) { return least_explained(*find_tag_family(name)).of_tag; };
    EXPECT_GT(level("DICT_4X4_1000"), level("DICT_4X4_50"));
    EXPECT_GT(level("DICT_4X4_50"), level("DICT_7X7_50"));
    EXPECT_NEAR(level("DICT_6X6_1000"), 0.4, 0.02);  // as many bits, nearly twice as many codes
}

/// Every print of every family on one texture each, all textures among them; on four each for the figures.
TEST(SlowFalseTags, Texture_HoldsNoTagOfAnyFamily) {
    constexpr int prints = 4, most_rounds = 4;
    const int rounds = fidservo::testing::draws(most_rounds, 1);
    std::mt19937_64 random(11);
    std::size_t tags = 0;
    int images = 0, first_round = 0;
    for (const TagFamily& family : tag_families()) {
        std::array<cv::Mat, prints * most_rounds> textures;
        for (std::size_t k = 0; k < textures.size(); ++k)
            textures[k] = texture(static_cast<int>(k % 8), random);
        for (int print = 0; print < prints; ++print)  // in turn: what decodes a print takes long to make
            for (int round = 0; round < rounds; ++round, ++images) {
                const int k = print + prints * ((first_round + round) % most_rounds);
                const TagReading reading{{&family, 1, print == 1}, print == 2};
                tags += expect_nothing(textures[static_cast<std::size_t>(k)], reading,
                                       fmt::format("texture {}", k));
            }
        ++first_round;
    }
    fmt::print("false tags in {} images of texture: {}\n", images, tags);
}

TEST(SlowFalseTags, PhotographsOfOtherThings_HoldNoTagOfAnyFamily) {
    const std::filesystem::path folder = std::filesystem::path(FIDSERVO_DATA_DIR) / "photos";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared data are absent";
    std::vector<std::pair<std::string, cv::Mat>> photographs;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        cv::Mat image =
            cv::imread(entry.path().string(), cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
        if (!image.empty()) photographs.emplace_back(entry.path().filename().string(), std::move(image));
    }
    std::size_t tags = 0;
    for (const TagFamily& family : tag_families())
        if (&family != &usual_tag_family())
            for (const auto& [name, image] : photographs) tags += expect_nothing(image, {{&family}}, name);
    fmt::print("false tags in photographs: {}\n", tags);
}

}  // namespace
}  // namespace fidservo::vision
