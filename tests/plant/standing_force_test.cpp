// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/standing_force.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

double volts_by_the_library(const StandingForce& force, double position_mm) {
    const double angle =
        2.0 * std::numbers::pi * position_mm / force.cogging_period_mm + force.cogging_phase_rad;
    return force.cogging_V * (std::sin(angle) + force.cogging_second_sine * std::sin(2.0 * angle) +
                              force.cogging_second_cosine * std::cos(2.0 * angle)) -
           force.cable_V_per_mm * (position_mm - force.cable_centre_mm);
}

TEST(StandingForceNearby, PlacesNearAndFar_GetTheForceOfTheirSine) {
    constexpr unsigned seed = 7;
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> along_mm(0.0, 200.0), step_mm(-0.6, 0.6);
    const StandingForce force{.cogging_V = 0.1,
                              .cogging_period_mm = 2.3,
                              .cogging_phase_rad = 0.7,
                              .cogging_second_sine = 0.2,
                              .cogging_second_cosine = -0.3,
                              .cable_V_per_mm = 0.002,
                              .cable_centre_mm = 90.0};
    StandingForceNearby nearby(force);
    for (int k = 0; k < 2000; ++k) {
        const double here_mm = along_mm(random);
        nearby.go_to(here_mm);
        for (const double position_mm : {here_mm, here_mm + step_mm(random), along_mm(random)})
            ASSERT_NEAR(nearby.volts(position_mm), volts_by_the_library(force, position_mm), 1e-13)
                << "seed " << seed << ", at " << position_mm << " mm";
    }
}

TEST(StandingForceNearby, NobodyWentAnywhere_StillGetsTheForce) {
    const StandingForce force{.cogging_V = 0.1, .cogging_period_mm = 5.0};
    EXPECT_NEAR(StandingForceNearby(force).volts(1.25), 0.1, 1e-15);
}

}  // namespace
}  // namespace fidservo::plant
