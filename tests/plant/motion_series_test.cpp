// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/motion_series.h"

#include "plant/dormand_prince.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

using State = std::array<double, 2>;

MotionSeries series_of(const ForcesOnMotion& forces, const StandingForce& standing, const State& start,
                       double duration_s) {
    const auto [sine, cosine] = StandingForceNearby(standing).sine_and_cosine(start[0]);
    return {forces, standing, sine, cosine, start[0], start[1], duration_s};
}

/// By a thousand steps of Dormand and Prince.
State integrated(const ForcesOnMotion& forces, const StandingForce& standing, State state,
                 double duration_s) {
    constexpr int steps = 1000;
    const auto rate = [&](const State& x) -> State {
        return {x[1], forces.constant_mm_per_s2 +
                          forces.standing_mm_per_s2_per_V * StandingForceNearby(standing).volts(x[0]) -
                          forces.damping_per_s * x[1]};
    };
    for (int k = 0; k < steps; ++k)
        state = dormand_prince_step(rate, state, rate(state), duration_s / steps).end;
    return state;
}

TEST(MotionSeries, Drag_SlowsByItsClosedForm) {
    constexpr double tau_s = 0.03, h_s = 1e-3, way_mm_per_s = 80.0;
    const State end = series_of({0.0, 0.0, 1.0 / tau_s}, {}, {5.0, way_mm_per_s}, h_s).at(1.0);
    EXPECT_NEAR(end[0], 5.0 + way_mm_per_s * tau_s * -std::expm1(-h_s / tau_s), 1e-13);
    EXPECT_NEAR(end[1], way_mm_per_s * std::exp(-h_s / tau_s), 1e-11);
}

TEST(MotionSeries, Spring_SwingsByItsClosedForm) {
    constexpr double w_rad_per_s = 100.0, h_s = 1e-3, out_mm = 3.0;
    const StandingForce spring{.cable_V_per_mm = 0.02, .cable_centre_mm = 40.0};
    const MotionSeries series =
        series_of({0.0, w_rad_per_s * w_rad_per_s / spring.cable_V_per_mm, 0.0}, spring, {43.0, 0.0}, h_s);
    for (const double share : {0.2, 1.0}) {
        EXPECT_NEAR(series.at(share)[0], 40.0 + out_mm * std::cos(w_rad_per_s * share * h_s), 1e-11);
        EXPECT_NEAR(series.at(share)[1], -out_mm * w_rad_per_s * std::sin(w_rad_per_s * share * h_s), 1e-9);
    }
}

TEST(MotionSeries, WavesAndHardeningSprings_AreWithinToleranceWhereTrusted) {
    constexpr unsigned seed = 11;
    constexpr double h_s = 1e-3, place_tolerance_mm = 1e-8, speed_tolerance_mm_per_s = 1e-6;
    std::mt19937_64 random(seed);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    int whole = 0, shorter = 0;
    for (int k = 0; k < 300; ++k) {
        const bool has_harmonic = k % 2 == 0;
        const StandingForce standing{.cogging_V = between(0.0, 0.2),
                                     .cogging_period_mm = between(1.0, 30.0),
                                     .cogging_phase_rad = between(-std::numbers::pi, std::numbers::pi),
                                     .cogging_second_sine = has_harmonic ? between(-0.5, 0.5) : 0.0,
                                     .cogging_second_cosine = has_harmonic ? between(-0.5, 0.5) : 0.0,
                                     .cable_V_per_mm = between(-2e-3, 2e-3),
                                     .cable_centre_mm = between(60.0, 140.0),
                                     .cable_hardening = k % 3 == 0 ? between(-1.0, 1.0) : 0.0};
        const ForcesOnMotion forces{between(-5e3, 5e3), between(2e3, 2e4), between(20.0, 80.0)};
        const State start{between(0.0, 200.0), between(-200.0, 200.0)};
        const MotionSeries series = series_of(forces, standing, start, h_s);
        const double share = series.trusted_share(place_tolerance_mm, speed_tolerance_mm_per_s);
        (share == 1.0 ? whole : shorter) += 1;
        ASSERT_GT(share, 0.05) << "seed " << seed << ", case " << k;
        const State reached = series.at(share), expected = integrated(forces, standing, start, share * h_s);
        ASSERT_NEAR(reached[0], expected[0], place_tolerance_mm) << "seed " << seed << ", case " << k;
        ASSERT_NEAR(reached[1], expected[1], speed_tolerance_mm_per_s) << "seed " << seed << ", case " << k;
    }
    EXPECT_GT(whole, 100);
    EXPECT_GT(shorter, 10);
}

}  // namespace
}  // namespace fidservo::plant
