// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/displacement.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace fidservo::vision {
namespace {

constexpr double std_px = 0.01;

RefinedTag square(int id, const Eigen::Vector2d& centre_px, double side_px, TimeNs time_ns) {
    TagDetection tag;
    const double h = side_px / 2;
    tag.tag_id = id;
    tag.time_ns = time_ns;
    tag.corners_px = {centre_px + Eigen::Vector2d(-h, h), centre_px + Eigen::Vector2d(h, h),
                      centre_px + Eigen::Vector2d(h, -h), centre_px + Eigen::Vector2d(-h, -h)};
    return tag_of_corners(tag, CornerCovariance::Identity() * (std_px * std_px));
}

TEST(Displacement, FirstFrame_IsZero) {
    DisplacementTracker tracker(1.2);
    const auto moved = tracker.add({square(4, {100, 100}, 300, 7)});
    ASSERT_EQ(moved.size(), 1U);
    EXPECT_EQ(moved[0].time_ns, 7);
    EXPECT_EQ(moved[0].tag_id, 4);
    EXPECT_EQ(moved[0].moved_um, Eigen::Vector2d::Zero());
    EXPECT_EQ(moved[0].std_um, Eigen::Vector2d::Zero());
}

TEST(Displacement, MotionInTheImage_IsScaledByTheTagsSide) {
    DisplacementTracker tracker(1.2);
    (void)tracker.add({square(4, {100, 100}, 300, 0)});
    const auto moved = tracker.add({square(4, {102.5, 99}, 300, 1)});
    EXPECT_NEAR(moved.at(0).moved_um.x(), 10.0, 1e-9);  // 1200 um / 300 px
    EXPECT_NEAR(moved.at(0).moved_um.y(), -4.0, 1e-9);
}

TEST(Displacement, Deviation_HoldsBothCentresAndTheScale) {
    DisplacementTracker tracker(1.2);
    (void)tracker.add({square(4, {100, 100}, 300, 0)});
    const auto moved = tracker.add({square(4, {400, 100}, 300, 1)});
    const double centres_um = std::sqrt(2.0) * std_px / 2 * 4.0;
    // Mean side: each of the four sides is a difference of two corners, every coordinate used once at 1/4.
    const double scale = std_px * std::sqrt(8.0) / 4 / 300;
    EXPECT_NEAR(moved.at(0).std_um.x(), std::hypot(centres_um, scale * 1200), 1e-9);
    EXPECT_NEAR(moved.at(0).std_um.y(), centres_um, 1e-9);
}

TEST(Displacement, EveryTag_CountsFromItsOwnFirstFrame) {
    DisplacementTracker tracker(1.2);
    (void)tracker.add({square(1, {100, 100}, 300, 0)});
    (void)tracker.add({square(1, {110, 100}, 300, 1), square(2, {500, 100}, 300, 1)});
    const auto moved = tracker.add({square(1, {120, 100}, 300, 2), square(2, {510, 100}, 300, 2)});
    ASSERT_EQ(moved.size(), 2U);
    EXPECT_NEAR(moved[0].moved_um.x(), 80.0, 1e-9);
    EXPECT_NEAR(moved[1].moved_um.x(), 40.0, 1e-9);
}

TEST(Displacement, SameIdTwiceInAFrame_IsLeftOut) {
    DisplacementTracker tracker(1.2);
    (void)tracker.add({square(1, {100, 100}, 300, 0)});
    EXPECT_TRUE(tracker.add({square(1, {110, 100}, 300, 1), square(1, {500, 100}, 300, 1)}).empty());
    EXPECT_EQ(tracker.add({square(1, {120, 100}, 300, 2)}).size(), 1U);
}

TEST(Displacement, TurnedTag_MovesByItsCentre) {
    DisplacementTracker tracker(1.2);
    (void)tracker.add({square(1, {100, 100}, 300, 0)});
    RefinedTag turned = square(1, {100, 100}, 300, 1);
    std::rotate(turned.detection.corners_px.begin(), turned.detection.corners_px.begin() + 1,
                turned.detection.corners_px.end());
    EXPECT_LT(tracker.add({turned}).at(0).moved_um.norm(), 1e-9);
}

}  // namespace
}  // namespace fidservo::vision
