// SPDX-License-Identifier: GPL-3.0-or-later
// Play and lag of known paths, and the wire's path in a recording.
#include "gap/residuals/wire_path.h"

#include "core/rig.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

TEST(WirePath, BehindPlay_ItRestsAfterAReversalUntilThePlayIsCrossed) {
    const std::vector<float> path{0.0F, 1.0F, 2.0F, 1.5F, 1.0F, 0.5F, 0.0F};
    const std::vector<float> behind = behind_play(path, 1.0);
    ASSERT_EQ(behind.size(), path.size());
    const float at_turn = behind[2];
    EXPECT_FLOAT_EQ(behind[3], at_turn);
    EXPECT_FLOAT_EQ(behind[4], at_turn);
    EXPECT_FLOAT_EQ(behind[5], at_turn - 0.5F);
    EXPECT_FLOAT_EQ(behind[6], at_turn - 1.0F);
}

TEST(WirePath, BehindNoPlay_ItIsThePathItself) {
    const std::vector<float> path{0.0F, 1.0F, 0.3F, 0.7F};
    EXPECT_EQ(behind_play(path, 0.0), path);
}

TEST(WirePath, BehindALag_AStepDecaysExponentially) {
    constexpr double tau_s = 0.02, tick_s = 1e-3;
    std::vector<double> step(100, 1.0);
    step.front() = 0.0;
    const std::vector<double> lagging = behind_lag(step, tau_s, tick_s);
    for (std::size_t k = 0; k < step.size(); ++k)
        EXPECT_NEAR(lagging[k], 1.0 - std::exp(-static_cast<double>(k) * tick_s / tau_s), 1e-12);
}

TEST(WirePath, BehindALag_WhatIsMissingIsSkipped) {
    const double missing = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> lagging = behind_lag(std::vector{2.0, missing, 2.0}, 0.02, 1e-3);
    EXPECT_EQ(lagging, (std::vector<double>{2.0, 2.0, 2.0}));
}

/// The recordings' commands heat the wire from cold through its transformation.
TEST(WirePath, OfARecording_IsTheContractionThatItsReadingShows) {
    const Evidence evidence = testing::campaign({}, {"micro-triangle"});
    const std::vector<float> path = wire_path_mm(evidence, 0);
    const gap::Course& course = evidence.course(0);
    ASSERT_EQ(path.size(), course.contraction_mm.size());
    double worst_mm = 0.0, most_mm = 0.0;
    for (std::size_t k = 0; k < path.size(); ++k) {
        if (!std::isfinite(course.contraction_mm[k])) continue;
        worst_mm = std::max(worst_mm, static_cast<double>(std::abs(path[k] - course.contraction_mm[k])));
        most_mm = std::max(most_mm, static_cast<double>(path[k]));
    }
    EXPECT_GT(most_mm, 1.0);
    EXPECT_LT(worst_mm, 0.1);
}

}  // namespace
}  // namespace fidservo
