// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/macro_axis.h"

#include "core/random.h"
#include "tests/plant/reference_rig.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

constexpr double tick_s = 0.001;

MacroAxis reference_axis() {
    return make_macro_axis(macro_axis_parameters(reference_rig()), tick_s);
}

MacroAxis endless_axis() {
    MacroAxisParameters parameters = macro_axis_parameters(reference_rig());
    parameters.low_mm = -std::numeric_limits<double>::infinity();
    parameters.high_mm = std::numeric_limits<double>::infinity();
    return make_macro_axis(parameters, tick_s);
}

/// Explicit integration with tiny steps, and stops without rebound at the ends.
MacroAxisState integrate(const MacroAxisParameters& p, MacroAxisState state, double command_V,
                         double time_s) {
    constexpr int steps = 20000;
    const double step_s = time_s / steps;
    const double terminal = p.velocity_gain_mm_per_s_per_V * effective_voltage_V(p, command_V);
    for (int k = 0; k < steps; ++k) {
        const double v = state.velocity_mm_per_s;
        const double v_next = v + step_s / p.time_constant_s * (terminal - v);
        state.position_mm += 0.5 * step_s * (v + v_next);
        state.velocity_mm_per_s = v_next;
        if (state.position_mm > p.high_mm) state = {p.high_mm, 0.0};
        if (state.position_mm < p.low_mm) state = {p.low_mm, 0.0};
    }
    return state;
}

TEST(MacroAxis, ReferenceRig_HasThePublishedTimeConstant) {
    EXPECT_NEAR(reference_axis().parameters.time_constant_s, 0.0235, 0.00005);
    EXPECT_NEAR(reference_axis().decay, 0.95833, 1e-12);
}

TEST(MacroAxis, DeadZone_GivesThePublishedVoltage) {
    const MacroAxisParameters p = reference_axis().parameters;
    EXPECT_EQ(effective_voltage_V(p, 2.9999), 0.0);
    EXPECT_EQ(effective_voltage_V(p, -2.9999), 0.0);
    EXPECT_DOUBLE_EQ(effective_voltage_V(p, 3.0), 0.364);
    EXPECT_DOUBLE_EQ(effective_voltage_V(p, -3.0), -0.364);
    EXPECT_DOUBLE_EQ(effective_voltage_V(p, 4.5), 0.364 + 0.636 * 1.5);
    EXPECT_DOUBLE_EQ(effective_voltage_V(p, 7.0), 0.364 + 0.636 * 2.0);
    EXPECT_DOUBLE_EQ(effective_voltage_V(p, -7.0), -0.364 - 0.636 * 2.0);
}

TEST(MacroAxis, RigWithoutDeadZone_PassesTheCommand) {
    MacroAxisParameters p = reference_axis().parameters;
    p.dead_zone = {};
    for (const double u : {-4.0, -1e-3, 0.0, 1e-3, 4.0}) EXPECT_EQ(effective_voltage_V(p, u), u);
}

TEST(MacroAxis, Step_FollowsTheClosedForm) {
    const MacroAxis axis = endless_axis();
    const double tau = axis.parameters.time_constant_s;
    const double terminal =
        axis.parameters.velocity_gain_mm_per_s_per_V * effective_voltage_V(axis.parameters, 4.0);
    MacroAxisState state{10.0, 0.0};
    for (int k = 1; k <= 1000; ++k) {
        advance(axis, state, 4.0);
        const double t = k * tick_s;
        ASSERT_NEAR(state.velocity_mm_per_s, terminal * (1.0 - std::exp(-t / tau)), 1e-9);
        ASSERT_NEAR(state.position_mm, 10.0 + terminal * (t - tau * (1.0 - std::exp(-t / tau))), 1e-9);
    }
}

TEST(MacroAxis, CommandInTheDeadZone_LetsTheCarriageCoastToRest) {
    const MacroAxis axis = endless_axis();
    const double tau = axis.parameters.time_constant_s;
    MacroAxisState state{0.0, 200.0};
    for (int k = 1; k <= 2000; ++k) {
        advance(axis, state, k % 2 == 0 ? 2.99 : -2.99);
        ASSERT_GE(state.velocity_mm_per_s, 0.0);
        ASSERT_NEAR(state.position_mm, 200.0 * tau * (1.0 - std::exp(-k * tick_s / tau)), 1e-9);
    }
    EXPECT_NEAR(state.position_mm, 200.0 * tau, 1e-9);
}

TEST(MacroAxis, EndOfTravel_StopsTheCarriageDeadAndHoldsItWhilePressed) {
    const MacroAxis axis = reference_axis();
    MacroAxisState state{190.0, 0.0};
    for (int k = 0; k < 500; ++k) {
        advance(axis, state, 5.0);
        ASSERT_LE(state.position_mm, 200.0);
    }
    EXPECT_EQ(state.position_mm, 200.0);
    EXPECT_EQ(state.velocity_mm_per_s, 0.0);
    advance(axis, state, 0.0);
    EXPECT_EQ(state.position_mm, 200.0);

    MacroAxisState free{100.0, 0.0};
    advance(axis, state, -5.0);
    advance(axis, free, -5.0);
    EXPECT_DOUBLE_EQ(state.velocity_mm_per_s, free.velocity_mm_per_s);
    EXPECT_NEAR(state.position_mm - 200.0, free.position_mm - 100.0, 1e-12);
}

TEST(MacroAxis, EndOfTravelMetInsideATick_MatchesTinySteps) {
    const MacroAxis axis = reference_axis();
    NoiseStream noise(3, "cases");
    int impacts = 0;
    for (int k = 0; k < 400; ++k) {
        const bool right = noise.uniform() < 0.5;
        const double gap_mm = 0.1 * noise.uniform();
        MacroAxisState state{right ? 200.0 - gap_mm : gap_mm, 600.0 * (noise.uniform() - 0.5)};
        const double command_V = 10.0 * (noise.uniform() - 0.5);
        const MacroAxisState expected = integrate(axis.parameters, state, command_V, tick_s);
        const MacroAxisState before = state;
        advance(axis, state, command_V);
        // Tiny steps meet the end up to one step late: 0.05 us at 300 mm/s, 15 nm; a stop costs 0.05 us of
        // push.
        ASSERT_NEAR(state.position_mm, expected.position_mm, 2e-5)
            << "seed 3, case " << k << " from " << before.position_mm << " at " << before.velocity_mm_per_s;
        ASSERT_NEAR(state.velocity_mm_per_s, expected.velocity_mm_per_s, 2e-3) << "seed 3, case " << k;
        impacts += state.position_mm == 0.0 || state.position_mm == 200.0;
    }
    EXPECT_GT(impacts, 50);
}

TEST(MacroAxis, TurnJustBeyondTheEnd_IsAnImpact) {
    // Moving outwards at v0 under full command inwards: the distance to the reversal has a closed form.
    const MacroAxis axis = reference_axis();
    const double tau = axis.parameters.time_constant_s;
    const double terminal =
        axis.parameters.velocity_gain_mm_per_s_per_V * effective_voltage_V(axis.parameters, -5.0);
    const double speed = 5.0;
    const double turn_s = tau * std::log(1.0 - speed / terminal);
    ASSERT_LT(turn_s, tick_s);
    const double way_mm = terminal * turn_s + (speed - terminal) * tau * (1.0 - std::exp(-turn_s / tau));

    MacroAxisState clear{200.0 - 1.001 * way_mm, speed}, hits{200.0 - 0.5 * way_mm, speed};
    const double clear_start = clear.position_mm;
    MacroAxisState free{100.0, speed};
    advance(axis, clear, -5.0);
    advance(axis, free, -5.0);
    EXPECT_NEAR(clear.position_mm - clear_start, free.position_mm - 100.0, 1e-12);
    EXPECT_DOUBLE_EQ(clear.velocity_mm_per_s, free.velocity_mm_per_s);
    advance(axis, hits, -5.0);
    EXPECT_LT(hits.velocity_mm_per_s, clear.velocity_mm_per_s)
        << "stopped early, it was pushed back for longer";
}

}  // namespace
}  // namespace fidservo::plant
