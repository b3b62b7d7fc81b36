// SPDX-License-Identifier: GPL-3.0-or-later
// An expected tag is found where it is, within the stated reach, and never where another one is.
#include "vision/tags/tag_alignment.h"

#include "core/random.h"
#include "tests/effort.h"
#include "tests/vision/quick_tag.h"

#include <cmath>
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace fidservo::vision {
namespace {

using testing::cells_of;
using testing::corners_of;
using testing::draw;
using testing::QuickPicture;
using testing::QuickTag;
using testing::turned;

constexpr int book_size = 587;
using Cells = std::array<std::array<bool, 8>, 8>;

double worst_corner_px(const TagDetection& found, const QuickTag& truth) {
    double worst = 0.0;
    for (std::size_t k = 0; k < 4; ++k)
        worst = std::max(worst, (found.corners_px[k] - corners_of(truth)[k]).norm());
    return worst;
}

/// Random draws that a test is made of.
class Draw {
  public:
    explicit Draw(std::uint64_t seed) : stream_(seed, "tags") {}
    double between(double low, double high) { return low + (high - low) * stream_.uniform(); }
    int below(int n) { return std::min(n - 1, static_cast<int>(n * stream_.uniform())); }

    QuickTag tag(int id) {
        const double side_px = between(60.0, 100.0);
        return {cells_of(id),
                {between(110.0, 130.0), between(80.0, 100.0)},
                side_px,
                between(-0.12, 0.12) + 0.5 * std::numbers::pi * below(4)};
    }
    /// The outline, moved by at most `most_px`, turned and scaled a little, as a prediction is.
    ExpectedTag expected(int id, const QuickTag& tag, double most_px) {
        const double way_px = 0.8 * most_px, turn_px = 0.1 * most_px;
        QuickTag believed = tag;
        believed.centre_px += Eigen::Vector2d(between(-way_px, way_px), between(-way_px, way_px));
        believed.side_px += between(-turn_px, turn_px);
        believed.angle_rad += between(-turn_px, turn_px) / tag.side_px;
        return {id, corners_of(believed), most_px};
    }

  private:
    NoiseStream stream_;
};

TEST(TagAlignment, TagWithinReach_IsFoundToHalfAPixelOrSo) {
    constexpr std::uint64_t seed = 11;
    constexpr int pictures = fidservo::testing::cases(400, 100);
    Draw random(seed);
    double squares = 0.0, worst = 0.0;
    for (int k = 0; k < pictures; ++k) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << ", picture " << k);
        const int id = random.below(book_size);
        const QuickTag tag = random.tag(id);
        const cv::Mat image = draw({tag}, {.seed = seed + k});
        const double third_of_a_cell = tag.side_px / 24.0;
        const auto found = align_tag(image, k, random.expected(id, tag, third_of_a_cell));
        ASSERT_TRUE(found) << found.error().text;
        EXPECT_EQ(found->tag_id, id);
        EXPECT_EQ(found->time_ns, k);
        EXPECT_EQ(found->corrected_bits, 0);
        worst = std::max(worst, worst_corner_px(*found, tag));
        squares += std::pow(worst_corner_px(*found, tag), 2);
    }
    std::printf("worst corner of a picture: r.m.s. %.2f px, worst of all %.2f px\n",
                std::sqrt(squares / pictures), worst);
    EXPECT_LT(worst, 1.0);
}

TEST(TagAlignment, LargeTagFifteenPixelsOff_IsFound) {
    constexpr std::uint64_t seed = 12;
    Draw random(seed);
    for (int k = 0; k < 60; ++k) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << ", picture " << k);
        const int id = random.below(book_size);
        const QuickTag tag{cells_of(id), {240.0, 200.0}, 310.0, random.between(-0.02, 0.02)};
        const int blur_px = 1 + 2 * random.below(3);
        const cv::Mat image =
            draw({tag}, {.size_px = {480, 400}, .motion_blur_px = blur_px, .seed = seed + k});
        ExpectedTag expected{id, corners_of(tag), 15.0};
        const Eigen::Vector2d off(random.below(2) == 0 ? -15.0 : 15.0, random.between(-15.0, 15.0));
        for (Eigen::Vector2d& corner : expected.corners_px) corner += off;
        const auto found = align_tag(image, 0, expected);
        ASSERT_TRUE(found) << found.error().text;
        EXPECT_LT(worst_corner_px(*found, tag), 1.0);
    }
}

TEST(SlowTagAlignment, AnotherTagAtThePlace_IsNeverTakenForTheExpectedOne) {
    constexpr std::uint64_t seed = 13;
    using fidservo::testing::cases;
    const int pictures = fidservo::testing::draws(cases(3000, 300), cases(600, 300));
    Draw random(seed);
    for (int k = 0; k < pictures; ++k) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << ", picture " << k);
        const int there = random.below(book_size);
        const int expected_id = (there + 1 + random.below(book_size - 1)) % book_size;
        QuickTag tag = random.tag(there);
        tag.black = random.between(30.0, 190.0);
        const cv::Mat image = draw({tag}, {.noise_grey = random.between(1.0, 8.0),
                                           .motion_blur_px = 1 + 2 * random.below(3),
                                           .seed = seed + k});
        const auto found =
            align_tag(image, 0, random.expected(expected_id, tag, random.between(0.0, tag.side_px / 4.0)));
        EXPECT_FALSE(found) << "tag " << there << " was taken for " << expected_id;
    }
}

TEST(TagAlignment, TheExpectedTagTurnedByQuarters_IsRefused) {
    constexpr std::uint64_t seed = 14;
    Draw random(seed);
    for (int k = 0; k < 600; ++k) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << ", picture " << k);
        const int id = random.below(book_size);
        const QuickTag tag = random.tag(id);
        QuickTag printed = tag;
        for (int quarter = 0; quarter <= k % 3; ++quarter) printed.white = turned(printed.white);
        EXPECT_FALSE(align_tag(draw({printed}, {.seed = seed + k}), 0, random.expected(id, tag, 2.0)));
    }
}

int differences(const Cells& a, const Cells& b) {
    int count = 0;
    for (std::size_t row = 0; row < 8; ++row)
        for (std::size_t column = 0; column < 8; ++column) count += a[row][column] != b[row][column] ? 1 : 0;
    return count;
}

TEST(TagAlignment, NearestCodesMisprintedTowardsEachOther_AreRefusedFromThreeBitsOn) {
    std::vector<Cells> book;
    book.reserve(book_size);
    for (int id = 0; id < book_size; ++id) book.push_back(cells_of(id));
    constexpr std::uint64_t seed = 15;
    Draw random(seed);
    int pairs = 0;
    for (int a = 0; a < book_size && pairs < 150; ++a)
        for (int b = a + 1; b < book_size && pairs < 150; ++b) {
            if (differences(book[a], book[b]) != 11) continue;
            ++pairs;
            for (const int left : {0, 2, 3, 5}) {
                SCOPED_TRACE(::testing::Message() << "seed " << seed << ", tag " << a << " printed as " << b
                                                  << " but for " << left << " bits");
                QuickTag tag = random.tag(a);
                int to_change = 11 - left;
                for (std::size_t row = 0; row < 8; ++row)
                    for (std::size_t column = 0; column < 8; ++column)
                        if (book[a][row][column] != book[b][row][column] && to_change > 0) {
                            tag.white[row][column] = book[b][row][column];
                            --to_change;
                        }
                const auto found =
                    align_tag(draw({tag}, {.seed = seed + pairs}), 0, random.expected(b, tag, 2.0));
                EXPECT_EQ(found.has_value(), left <= 2);
            }
        }
    EXPECT_EQ(pairs, 150);
}

TEST(TagAlignment, EmptyPaperAndNoise_HoldNoTag) {
    constexpr std::uint64_t seed = 16;
    Draw random(seed);
    for (int k = 0; k < fidservo::testing::cases(1000, 100); ++k) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << ", picture " << k);
        const int id = random.below(book_size);
        const double noise_grey = k % 2 == 0 ? 2.0 : 60.0;
        const cv::Mat image = draw({}, {.paper = 128.0, .noise_grey = noise_grey, .seed = seed + k});
        EXPECT_FALSE(align_tag(image, 0, random.expected(id, random.tag(id), 8.0)));
    }
}

TEST(TagAlignment, OneSideCovered_IsPlacedByTheOthers) {
    constexpr std::uint64_t seed = 17;
    Draw random(seed);
    for (int k = 0; k < 100; ++k) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << ", picture " << k);
        const int id = random.below(book_size);
        const QuickTag tag{
            cells_of(id), {120.0 + random.between(-1, 1), 90.0 + random.between(-1, 1)}, 120.0};
        cv::Mat image = draw({tag}, {.seed = seed + k});
        // Half of the left border and all that lies to its left.
        cv::rectangle(image, cv::Rect(0, 0, static_cast<int>(tag.centre_px.x() - 60.0 + 3.0), 180), 128,
                      cv::FILLED);
        ExpectedTag expected{id, corners_of(tag), 5.0};
        const Eigen::Vector2d off(random.between(-4, 4), random.between(-4, 4));
        for (Eigen::Vector2d& corner : expected.corners_px) corner += off;
        const auto found = align_tag(image, 0, expected);
        ASSERT_TRUE(found) << found.error().text;
        EXPECT_LT(worst_corner_px(*found, tag), 5.0);
    }
}

TEST(TagAlignment, OutlinesAcrossTheImageBorder_DoNoHarm) {
    constexpr std::uint64_t seed = 18;
    Draw random(seed);
    for (int k = 0; k < 300; ++k) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << ", picture " << k);
        const int id = random.below(book_size);
        QuickTag tag = random.tag(id);
        tag.centre_px = {random.between(-80, 320), random.between(-80, 260)};
        const cv::Mat image = draw({tag}, {.seed = seed + k});
        const auto found = align_tag(image, 0, random.expected(id, tag, 3.0));
        if (found) {
            EXPECT_LT(worst_corner_px(*found, tag), 4.0);
        }
    }
}

TEST(TagAlignment, OutlinesWithoutAnArea_HoldNoTag) {
    const cv::Mat image = draw({}, {});
    for (const double size : {0.0, 1.0, 10.0}) {
        const Eigen::Vector2d at(100.0, 90.0), x(size, 0.0);
        EXPECT_FALSE(align_tag(image, 0, {3, {at, at + x, at + 2 * x, at + 3 * x}, 5.0}));
    }
    EXPECT_FALSE(align_tag(image, 0, {3, {}, 5.0}));
}

}  // namespace
}  // namespace fidservo::vision
