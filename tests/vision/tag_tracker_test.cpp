// SPDX-License-Identifier: GPL-3.0-or-later
// Tags followed through motion, jumps, covers, exchanges and empty frames. Truth: what was drawn.
#include "vision/tags/tag_tracker.h"

#include "core/random.h"
#include "tests/effort.h"
#include "tests/vision/quick_tag.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace fidservo::vision {
namespace {

using testing::cells_of;
using testing::corners_of;
using testing::draw;
using testing::QuickPicture;
using testing::QuickTag;

constexpr TimeNs frame_ns = 20 * ns_per_ms;

double worst_corner_px(const TagDetection& found, const QuickTag& truth) {
    double worst = 0.0;
    for (std::size_t k = 0; k < 4; ++k)
        worst = std::max(worst, (found.corners_px[k] - corners_of(truth)[k]).norm());
    return worst;
}

/// Border and a white rim of half a cell are in the picture.
bool in_view(const QuickTag& tag, const cv::Size& size) {
    const double rim = tag.side_px / 16.0;
    const auto corners = corners_of(tag);
    return std::all_of(corners.begin(), corners.end(), [&](const Eigen::Vector2d& c) {
        return c.x() > rim && c.y() > rim && c.x() < size.width - 1 - rim && c.y() < size.height - 1 - rim;
    });
}

TEST(TagTracker, SteadyMotion_IsTrackedWithoutASearch) {
    TagTracker tracker;
    QuickTag tag{cells_of(7), {80.0, 90.0}, 80.0};
    std::map<FoundBy, int> found_by;
    for (int k = 0; k < 12; ++k, tag.centre_px.x() += 7.3) {
        const auto tags = tracker.track(draw({tag}, {.seed = 100U + k}), k * frame_ns);
        ASSERT_EQ(tags.size(), 1U) << k;
        EXPECT_EQ(tags[0].tag.detection.tag_id, 7);
        EXPECT_LT(worst_corner_px(tags[0].tag.detection, tag), 0.5);
        ++found_by[tags[0].found_by];
    }
    EXPECT_EQ(found_by[FoundBy::full_search], 1);    // the first frame
    EXPECT_EQ(found_by[FoundBy::region_search], 1);  // the second: the velocity is not known
    EXPECT_EQ(found_by[FoundBy::tracking], 10);
}

TEST(TagTracker, KnownMotionOfTheStage_IsTrackedFromTheSecondFrameOn) {
    TagTracker tracker;
    QuickTag tag{cells_of(7), {60.0, 90.0}, 80.0};
    NoiseStream noise(3, "steps");
    PictureMotion motion{{0.0, 0.0}, 3.0};
    for (int k = 0; k < 10; ++k) {
        const auto tags = tracker.track(draw({tag}, {.seed = 200U + k}), k * frame_ns, motion);
        ASSERT_EQ(tags.size(), 1U) << k;
        EXPECT_EQ(tags[0].found_by, k == 0 ? FoundBy::full_search : FoundBy::tracking) << k;
        EXPECT_LT(worst_corner_px(tags[0].tag.detection, tag), 0.5);
        motion.shift_px.x() = k % 2 == 0 ? 110.0 : -110.0;
        tag.centre_px.x() += motion.shift_px.x() + 4.0 * (noise.uniform() - 0.5);
    }
}

TEST(TagTracker, Jump_IsFoundBySearchAndFollowedOn) {
    TagTracker tracker;
    QuickTag tag{cells_of(31), {60.0, 60.0}, 70.0};
    (void)tracker.track(draw({tag}, {}), 0);
    tag.centre_px = {180.0, 120.0};
    const auto jumped = tracker.track(draw({tag}, {}), frame_ns);
    ASSERT_EQ(jumped.size(), 1U);
    EXPECT_EQ(jumped[0].found_by, FoundBy::full_search);
    EXPECT_LT(worst_corner_px(jumped[0].tag.detection, tag), 0.5);
    const auto at_rest = tracker.track(draw({tag}, {}), 2 * frame_ns, PictureMotion{{0.0, 0.0}, 1.0});
    ASSERT_EQ(at_rest.size(), 1U);
    EXPECT_EQ(at_rest[0].found_by, FoundBy::tracking);
}

TEST(TagTracker, TagThatEnters_IsSeenWhenTheTrackerLooksAround) {
    TagTrackerOptions options;
    options.look_around_every = 5;
    TagTracker tracker(options);
    const QuickTag first{cells_of(1), {60.0, 90.0}, 70.0}, second{cells_of(2), {180.0, 90.0}, 70.0};
    std::size_t most = 0;
    for (int k = 0; k < 8; ++k) {
        const auto tags = tracker.track(k == 0 ? draw({first}, {}) : draw({first, second}, {}), k * frame_ns);
        most = std::max(most, tags.size());
        EXPECT_EQ(tags.size(), k < 5 ? 1U : 2U) << k;
    }
    EXPECT_EQ(most, 2U);
}

TEST(TagTracker, TagThatLeaves_IsGoneAndTheOtherOneStaysTracked) {
    TagTracker tracker;
    QuickTag leaving{cells_of(1), {60.0, 90.0}, 70.0}, staying{cells_of(2), {170.0, 90.0}, 70.0};
    for (int k = 0; k < 12; ++k) {
        const PictureMotion motion{{-4.0, 0.0}, 1.0};
        const auto tags = tracker.track(draw({leaving, staying}, {}), k * frame_ns,
                                        k == 0 ? std::nullopt : std::optional(motion));
        for (const TrackedTag& tag : tags) {
            const QuickTag& truth = tag.tag.detection.tag_id == 1 ? leaving : staying;
            EXPECT_LT(worst_corner_px(tag.tag.detection, truth), 0.5);
            if (k > 0) {
                EXPECT_EQ(tag.found_by, FoundBy::tracking) << k;
            }
        }
        if (in_view(leaving, {240, 180})) {
            EXPECT_EQ(tags.size(), 2U) << k;
        }
        if (corners_of(leaving)[0].x() < -1.0) {
            EXPECT_EQ(tags.size(), 1U) << k;
        }
        leaving.centre_px.x() -= 4.0;
        staying.centre_px.x() -= 4.0;
    }
}

TEST(TagTracker, TwoTagsWithTheSameId_AreBothFollowed) {
    TagTracker tracker;
    QuickTag left{cells_of(5), {60.0, 90.0}, 70.0}, right{cells_of(5), {170.0, 90.0}, 70.0};
    for (int k = 0; k < 6; ++k) {
        const auto tags = tracker.track(draw({left, right}, {.seed = 7U + k}), k * frame_ns);
        EXPECT_EQ(tags.size(), 2U) << k;
        left.centre_px.x() += 2.0;
        right.centre_px.x() += 2.0;
    }
}

/// What happens to the tag in a frame.
enum class Event { moves, jumps, covered, exchanged, blank };

Event draw_event(double u) {
    if (u < 0.70) return Event::moves;
    if (u < 0.78) return Event::jumps;
    if (u < 0.86) return Event::covered;
    if (u < 0.94) return Event::exchanged;
    return Event::blank;
}

TEST(SlowTagTracker, WhateverHappensToTheTag_NoWrongIdAndNoTagMissed) {
    constexpr std::uint64_t seed = 21;
    using fidservo::testing::cases;
    constexpr int frames = 25;
    const int sequences = fidservo::testing::draws(cases(60, 8), cases(20, 8));
    NoiseStream random(seed, "events");
    const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    const cv::Size size(240, 180);
    std::map<FoundBy, int> found_by;
    for (int sequence = 0; sequence < sequences; ++sequence) {
        TagTracker tracker;
        int id = static_cast<int>(between(0, 587));
        QuickTag tag{cells_of(id), {between(60, 180), between(60, 120)}, between(50, 80), between(-3.1, 3.1)};
        Eigen::Vector2d step(between(-3, 3), between(-3, 3));
        for (int k = 0; k < frames; ++k) {
            SCOPED_TRACE(::testing::Message()
                         << "seed " << seed << ", sequence " << sequence << ", frame " << k);
            const Event event = draw_event(random.uniform());
            step += Eigen::Vector2d(between(-1, 1), between(-1, 1));
            tag.centre_px += step;
            if (event == Event::jumps) tag.centre_px = {between(30, 210), between(30, 150)};
            if (event == Event::exchanged) {
                id = static_cast<int>(between(0, 587));
                tag.white = cells_of(id);
            }
            const QuickPicture how{.size_px = size,
                                   .motion_blur_px = 1 + 2 * static_cast<int>(between(0, 3)),
                                   .seed = seed + 1000U * sequence + k};
            const bool shown = event != Event::blank;
            cv::Mat image = draw(shown ? std::vector{tag} : std::vector<QuickTag>{}, how);
            if (event == Event::covered) {
                const Eigen::Vector2d at = tag.centre_px - Eigen::Vector2d::Constant(0.25 * tag.side_px);
                const int width = static_cast<int>(tag.side_px * between(0.2, 0.9));
                cv::rectangle(image,
                              cv::Rect(static_cast<int>(at.x()), static_cast<int>(at.y()), width, width),
                              static_cast<double>(between(0, 255)), cv::FILLED);
            }
            const auto tags = tracker.track(image, (sequence * frames + k) * frame_ns);
            EXPECT_LE(tags.size(), 1U);
            for (const TrackedTag& seen : tags) {
                ASSERT_TRUE(shown);
                EXPECT_EQ(seen.tag.detection.tag_id, id);
                // A tag whose white rim is cut off has edges that nobody can measure.
                const bool clear = event != Event::covered && in_view(tag, size);
                EXPECT_LT(worst_corner_px(seen.tag.detection, tag), clear ? 1.0 : tag.side_px / 6.0);
                ++found_by[seen.found_by];
            }
            if (shown && event != Event::covered && in_view(tag, size)) {
                EXPECT_EQ(tags.size(), 1U);
            }
        }
    }
    std::printf("tracked %d, by region %d, by full search %d\n", found_by[FoundBy::tracking],
                found_by[FoundBy::region_search], found_by[FoundBy::full_search]);
    EXPECT_GT(found_by[FoundBy::tracking], found_by[FoundBy::full_search]);
}

TEST(TagTracker, FullDetectionAndTracking_GiveTheSameMeasurement) {
    constexpr std::uint64_t seed = 22;
    NoiseStream random(seed, "places");
    TagTracker tracker;
    TagDetector detector;
    double worst_std = 0.0;
    for (int k = 0; k < 60; ++k) {
        const QuickTag tag{
            cells_of(9), {120.0 + 2.0 * random.uniform(), 90.0 + 2.0 * random.uniform()}, 100.0};
        const cv::Mat image = draw({tag}, {.seed = seed + k});
        const auto tracked = tracker.track(image, k * frame_ns, PictureMotion{{0, 0}, 3.0});
        const auto searched = detector.detect(image, k * frame_ns);
        ASSERT_EQ(tracked.size(), 1U);
        ASSERT_EQ(searched.size(), 1U);
        if (k > 0) {
            EXPECT_EQ(tracked[0].found_by, FoundBy::tracking);
        }
        const auto refined = refine_tag(image, searched[0]);
        ASSERT_TRUE(refined);
        const Eigen::Vector2d apart = tracked[0].tag.centre_px - refined->centre_px;
        const Eigen::Vector2d std = refined->centre_covariance_px2.diagonal().cwiseSqrt();
        worst_std = std::max(worst_std, apart.cwiseAbs().cwiseQuotient(std).maxCoeff());
    }
    std::printf("tracking and full detection differ by %.3f standard deviations at most\n", worst_std);
    EXPECT_LT(worst_std, 2.0);
}

}  // namespace
}  // namespace fidservo::vision
