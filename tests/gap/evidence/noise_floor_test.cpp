// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/evidence/noise_floor.h"

#include "core/random.h"
#include "tests/campaign.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

TEST(NoiseFloor, RoundedVarianceSpreadOverAStep_IsNoisePlusATwelfth) {
    constexpr int parts = 200;
    double sum = 0.0;
    for (int k = 0; k < parts; ++k) {
        const double mean = (k + 0.5) / parts;
        sum += rounded_variance(mean, 0.4);
    }
    // The mean variance about each mean's own rounded mean: less by what the rounded mean strays.
    double stray = 0.0;
    for (int k = 0; k < parts; ++k) {
        const auto about = testing::rounded_gaussian((k + 0.5) / parts, 0.4);
        stray += about.mean - rounded_variance((k + 0.5) / parts, 0.4);
    }
    EXPECT_NEAR((sum + stray) / parts, 0.4 * 0.4 + 1.0 / 12.0, 1e-6);
}

/// Frames of one tag at rest: the refined corners scatter less than the detector's, which every third frame
/// has.
TEST(NoiseFloor, CornersThatCouldNotBeRefined_DoNotCountBesideThoseThatWere) {
    constexpr double frame_s = 0.02, refined_px = 0.01, found_px = 0.2;
    NoiseStream noise(17, "corners");
    Recording recording;
    for (int frame = 0; frame < 600; ++frame) {
        TagDetection detection;
        detection.time_ns = nanoseconds(frame_s * frame);
        detection.tag_id = 5;
        detection.is_refined = frame % 3 != 0;
        const double scatter_px = frame % 3 != 0 ? refined_px : found_px;
        for (Eigen::Vector2d& corner_px : detection.corners_px)
            corner_px = Eigen::Vector2d(400.0, 300.0 + scatter_px * noise.normal());
        recording.detections.push_back(detection);
    }
    EXPECT_NEAR(corner_noise_px({recording}, frame_s).value(), refined_px, 0.15 * refined_px);
    for (TagDetection& detection : recording.detections) detection.is_refined.reset();
    EXPECT_GT(corner_noise_px({recording}, frame_s).value(), 2.0 * refined_px);
}

TEST(NoiseFloor, RestAtOnePlace_NoiseIsFoundWhereverInAStepItIs) {
    for (const double mean : {1024.0, 1024.3, 1024.5}) {
        NoiseStream noise(7, "rest");
        std::vector<double> reading;
        constexpr int rows = 40'000;
        reading.reserve(rows);
        for (int k = 0; k < rows; ++k) reading.push_back(std::floor(mean + 0.4 * noise.normal() + 0.5));
        const auto found =
            noise_before_rounding(quiet_stretches(reading, std::vector<double>(reading.size(), 0.0)));
        ASSERT_TRUE(found);
        EXPECT_NEAR(*found, 0.4, 0.006) << mean << ", seed 7";  // four standard deviations
    }
}

TEST(NoiseFloor, CarriageThatNeverFlickers_HasNoNoise) {
    const auto found = noise_before_rounding(
        quiet_stretches(std::vector<double>(1000, 17.0), std::vector<double>(1000, 0.0)));
    ASSERT_TRUE(found);
    EXPECT_LT(*found, 1e-3);
}

}  // namespace

}  // namespace fidservo
