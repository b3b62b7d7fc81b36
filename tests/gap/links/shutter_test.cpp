// SPDX-License-Identifier: GPL-3.0-or-later
// Exposure and readout times from the frames themselves, and which detections are sharp, against formulas.
#include "gap/links/shutter.h"

#include "core/rig.h"
#include "gap/evidence/clear_detections.h"
#include "tests/gap/looks.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;
using testing::looks_in_even_motion;

const CameraParameters& camera() {
    static const CameraParameters reference = *reference_rig().camera;
    return reference;
}

/// The shutter of a camera that was recorded at rest and in motion.
Shutter seen(const plant::CameraDeviation& truth, double speed_px_per_s = testing::looks_px_per_s) {
    std::array recordings{looks_in_even_motion(truth, 0.0), looks_in_even_motion(truth, speed_px_per_s)};
    std::array images{image_run(recordings[0], camera()), image_run(recordings[1], camera())};
    return seen_shutter(recordings, images, camera());
}

TEST(Shutter, LongerExposure_IsSeenInWhatMoves) {
    EXPECT_NEAR(seen({.extra_exposure_s = 6e-3}).exposure_s, camera().exposure_s + 6e-3, 1e-9);
    EXPECT_DOUBLE_EQ(seen({.extra_exposure_s = 6e-3}, 100.0).exposure_s, camera().exposure_s);
    EXPECT_NEAR(seen({}).exposure_s, camera().exposure_s, 1e-9);
}

TEST(Shutter, ReadoutOfEitherSign_IsSeenInWhatMoves) {
    for (const double readout_s : {8e-3, -3e-3, 0.0})
        for (const double speed_px_per_s : {375.0, -500.0})
            EXPECT_NEAR(seen({.readout_s = readout_s}, speed_px_per_s).readout_s, readout_s, 1e-9);
    EXPECT_EQ(seen({.readout_s = 8e-3}, 100.0).readout_s, 0.0);
}

/// Times of the detections that count as sharp for a carriage of constant velocity.
std::vector<TimeNs> clear_of(Recording recording, double velocity_mm_per_s, double exposure_s) {
    const std::vector<double> velocities(recording.rows.size(), velocity_mm_per_s);
    drop_unclear(recording, velocities, reference_rig(), exposure_s, smeared_tags(recording));
    std::vector<TimeNs> times;
    for (const TagDetection& tag : recording.detections) times.push_back(tag.time_ns);
    return times;
}

TEST(ClearDetections, NotRefined_AreLeftOutWhereOthersAre) {
    Recording recording = looks_in_even_motion({}, 0.0);
    const std::size_t all = clear_of(recording, 0.0, 2e-3).size();
    recording.detections[20].is_refined = false;
    EXPECT_EQ(clear_of(recording, 0.0, 2e-3).size(), all) << "nothing is known of the others";
    recording.detections[21].is_refined = true;
    EXPECT_EQ(clear_of(recording, 0.0, 2e-3).size(), all - 1);
}

TEST(ClearDetections, AllButTheFirstAndTheLastOfATag_AreKept) {
    const Recording still = looks_in_even_motion({}, 0.0);
    EXPECT_EQ(clear_of(still, 0.0, 2e-3).size(), still.detections.size() - 2);
    Recording with_gap = still;
    with_gap.detections.erase(with_gap.detections.begin() + 20);
    EXPECT_EQ(clear_of(with_gap, 0.0, 2e-3).size(), with_gap.detections.size() - 4);
}

TEST(ClearDetections, SmearedByCarriageOrInFrames_AreDropped) {
    const Recording still = looks_in_even_motion({}, 0.0), moving = looks_in_even_motion({}, 375.0);
    // 0.15 cells are 22.5 um of the plate, 5.6 px of the image.
    EXPECT_EQ(clear_of(still, 11.0, 2e-3).size(), still.detections.size() - 2);
    EXPECT_TRUE(clear_of(still, 11.5, 2e-3).empty());
    EXPECT_EQ(clear_of(moving, 0.0, 14e-3).size(), moving.detections.size() - 2);
    EXPECT_TRUE(clear_of(moving, 0.0, 16e-3).empty());
}

TEST(ClearDetections, WhoseLooksAreSmeared_AreDroppedWhateverTheExposureIsSaidToBe) {
    constexpr double said_s = 2e-3;
    const auto kept = [&](double extra_exposure_s) {
        return clear_of(looks_in_even_motion({.extra_exposure_s = extra_exposure_s}, 375.0), 0.0, said_s)
            .size();
    };
    EXPECT_EQ(kept(12e-3), 48U);
    EXPECT_EQ(kept(14e-3), 0U);

    Recording one = looks_in_even_motion({}, 375.0);
    one.appearances[20].sides[1] = one.appearances[20].sides[3] = {};  // too wide to be measured
    EXPECT_EQ(clear_of(one, 0.0, said_s).size(), 47U);
    for (TagAppearance& out_of_focus : one.appearances) out_of_focus.sides.fill({});
    EXPECT_EQ(clear_of(one, 0.0, said_s).size(), 48U);
}

TEST(ClearDetections, NearTheBorder_AreDropped) {
    Recording still = looks_in_even_motion({}, 0.0);
    const auto shift = [&](double u_px) {
        Recording shifted = still;
        for (TagDetection& tag : shifted.detections)
            for (Eigen::Vector2d& corner : tag.corners_px) corner.x() += u_px;
        return shifted;
    };
    // Half a cell of the 300 px wide tag is 19 px; its left side is at 50 px.
    EXPECT_FALSE(clear_of(shift(-30.0), 0.0, 2e-3).empty());
    EXPECT_TRUE(clear_of(shift(-32.0), 0.0, 2e-3).empty());
}

}  // namespace
}  // namespace fidservo
