// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/subpixel_edge.h"

#include "core/failure.h"
#include "core/random.h"
#include "core/result.h"
#include "tests/vision_features/consistency.h"
#include "vision/features/normal_law.h"

#include <cmath>
#include <vector>

namespace fidservo::vision::testing {
namespace {

const GreyNoise noise{255.0 / 10000.0, 0.1};
const BlurPrior blur{0.8, 0.3};

/// Four rows of pixels across an edge at `position`, with noise where a stream is given.
std::vector<EdgeSample> edge_profile(double position, double low, double high,
                                     NoiseStream* random = nullptr) {
    std::vector<EdgeSample> samples;
    for (int row = 0; row < 4; ++row)
        for (int k = -4; k <= 4; ++k) {
            const double t = k + 0.25 * row;
            double grey = low + (high - low) * normal_cdf((t - position) / edge_sigma_px(0.8));
            if (random != nullptr) grey += std::sqrt(noise.variance(grey)) * random->normal();
            samples.push_back({t, grey});
        }
    return samples;
}

TEST(LocateEdge, NoiseFreeProfile_IsRecoveredExactly) {
    for (const double position : {-1.3, 0.0, 0.37, 1.9}) {
        const auto edge = locate_edge(edge_profile(position, 25.0, 220.0), noise, blur);
        ASSERT_TRUE(edge);
        EXPECT_NEAR(edge->position_px, position, 1e-6);
        EXPECT_NEAR(edge->low_side_grey, 25.0, 1e-3);
        EXPECT_NEAR(edge->high_side_grey, 220.0, 1e-3);
        EXPECT_NEAR(optical_blur_px(edge->sigma_px), 0.8, 1e-5);
    }
}

TEST(LocateEdge, FallingEdge_IsTheRisingOnesMirrorImage) {
    const auto edge = locate_edge(edge_profile(0.4, 220.0, 25.0), noise, blur);
    ASSERT_TRUE(edge);
    EXPECT_NEAR(edge->position_px, 0.4, 1e-6);
    EXPECT_GT(edge->low_side_grey, edge->high_side_grey);
}

TEST(LocateEdge, NoisyProfiles_ScatterAsStated) {
    constexpr std::uint64_t seed = 11;
    SCOPED_TRACE(seed);
    NoiseStream random(seed, "edges");
    Consistency position;
    double chi2 = 0.0;
    int degrees = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const double truth = 2.0 * random.uniform() - 1.0;
        const auto edge = locate_edge(edge_profile(truth, 25.0, 220.0, &random), noise, blur);
        ASSERT_TRUE(edge);
        position.add({edge->position_px, edge->position_std_px}, truth);
        chi2 += edge->chi2;
        degrees += edge->degrees_of_freedom;
    }
    expect_consistent(position, 1e-3, "position");
    EXPECT_NEAR(chi2 / degrees, 1.0, 0.03);
}

TEST(LocateEdge, WhatIsNoEdge_HasAReason) {
    EXPECT_TRUE(
        fails_with(locate_edge(edge_profile(0.0, 200.0, 201.0), noise, blur), Reason::not_identifiable));
    EXPECT_TRUE(
        fails_with(locate_edge(edge_profile(9.0, 25.0, 220.0), noise, blur), Reason::not_identifiable));
    EXPECT_TRUE(fails_with(locate_edge({}, noise, blur), Reason::not_identifiable));
    auto clipped = edge_profile(0.0, 25.0, 300.0);
    for (EdgeSample& sample : clipped) sample.grey = std::min(sample.grey, white_grey);
    EXPECT_TRUE(fails_with(locate_edge(clipped, noise, blur), Reason::glare));
}

TEST(LocateStrip, NoiseFreeStrips_AreRecoveredDownToAFractionOfTheBlur) {
    const double sigma = edge_sigma_px(0.8);
    for (const double width : {0.5, 2.0, 5.0, 12.0}) {
        std::vector<EdgeSample> samples;
        for (int row = 0; row < 4; ++row)
            for (int k = -12; k <= 12; ++k) {
                const double t = k + 0.25 * row;
                const double covered =
                    normal_cdf((t - 0.3 + width / 2) / sigma) - normal_cdf((t - 0.3 - width / 2) / sigma);
                samples.push_back({t, (200.0 + 0.5 * t) * (1.0 - 0.85 * covered)});
            }
        const StripPrior prior{{0.8, 0.01}, 0.0, 3.0, 0.85, 0.01};
        const auto strip = locate_strip(samples, noise, prior);
        ASSERT_TRUE(strip) << width;
        EXPECT_NEAR(strip->width_px, width, 1e-3);
        EXPECT_NEAR(strip->centre_px, 0.3, 1e-3);
    }
}

TEST(NormalExceeded, IsTheInverseOfTheTail) {
    for (const double z : {-2.0, 0.0, 1.0, 6.3}) EXPECT_NEAR(normal_exceeded(normal_cdf(-z)), z, 1e-9);
    EXPECT_NEAR(expected_greatest(100), 2.508, 0.03);
}

}  // namespace
}  // namespace fidservo::vision::testing
