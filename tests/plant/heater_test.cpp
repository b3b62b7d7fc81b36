// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/heater.h"

#include "core/random.h"
#include "core/rig.h"
#include "tests/plant/reference_rig.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

constexpr double tick_s = 0.001;

Heater reference_heater() {
    return make_heater(reference_rig().micro->heater, tick_s);
}

/// Explicit integration with tiny steps that chooses the time constant anew at each of them.
double integrate_degC(const HeaterParameters& p, double temp_degC, double command_V, double time_s) {
    constexpr int steps = 20000;
    const double phi = std::max(0.0, p.gain_degC_per_V * (std::min(command_V, p.limit_V) - p.onset_V));
    for (int k = 0; k < steps; ++k) {
        const double rise = temp_degC - p.ambient_degC;
        temp_degC += time_s / steps * (phi - rise) / (phi > rise ? p.heating_tau_s : p.cooling_tau_s);
    }
    return temp_degC;
}

TEST(Heater, FullVoltageFromCold_RisesWithTheHeatingTimeConstant) {
    const Heater heater = reference_heater();
    HeaterState state{22.0};
    for (int k = 0; k < 550; ++k) advance(heater, state, 1.9);
    EXPECT_NEAR(state.temp_degC, 22.0 + 272.0 * 0.6 * (1.0 - std::exp(-1.0)), 1e-9);
    for (int k = 0; k < 20000; ++k) advance(heater, state, 1.9);
    EXPECT_NEAR(state.temp_degC, 22.0 + 272.0 * 0.6, 1e-9);
}

TEST(Heater, HeaterOff_CoolsWithTheCoolingTimeConstant) {
    const Heater heater = reference_heater();
    HeaterState state{122.0};
    for (int k = 0; k < 1000; ++k) advance(heater, state, 0.0);
    EXPECT_NEAR(state.temp_degC, 22.0 + 100.0 * std::exp(-1.0), 1e-9);
}

TEST(Heater, BelowOnsetAndAboveLimit_ActsAsAtTheBounds) {
    const Heater heater = reference_heater();
    HeaterState off{22.0}, onset{22.0}, limit{22.0}, beyond{22.0};
    advance(heater, off, 0.7);
    advance(heater, onset, 1.3);
    advance(heater, limit, 1.9);
    advance(heater, beyond, 5.0);
    EXPECT_EQ(off.temp_degC, 22.0);
    EXPECT_EQ(onset.temp_degC, 22.0);
    EXPECT_GT(limit.temp_degC, 22.0);
    EXPECT_EQ(beyond.temp_degC, limit.temp_degC);
}

TEST(Heater, RandomCommandsAcrossEquilibrium_MatchTinySteps) {
    const Heater heater = reference_heater();
    NoiseStream noise(5, "cases");
    for (int k = 0; k < 200; ++k) {
        // Within 0.2 degC of the temperature that the command holds, where a tick could mistake the regime.
        const double command_V = 1.35 + 0.5 * noise.uniform();
        const double held_degC = 22.0 + 272.0 * (command_V - 1.3);
        HeaterState state{held_degC + 0.4 * (noise.uniform() - 0.5)};
        const double expected = integrate_degC(heater.parameters, state.temp_degC, command_V, tick_s);
        const bool from_below = state.temp_degC < held_degC;
        advance(heater, state, command_V);
        ASSERT_NEAR(state.temp_degC, expected, 1e-10) << "seed 5, case " << k;
        ASSERT_EQ(state.temp_degC < held_degC, from_below) << "the equilibrium is never crossed";
    }
}

}  // namespace
}  // namespace fidservo::plant
