// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/plant/effects/effect_rig.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

StageState after(const StagePlant& plant, double macro_V, int ticks) {
    StageState state = start(plant, 50.0, 1, EncoderOrigin::end_of_travel);
    for (int k = 0; k < ticks; ++k) advance(plant, state, macro_V, 0.0);
    return state;
}

TEST(DriveGain, Command_IsAmplifiedBeforeTheDeadZone) {
    const MacroAxisParameters axis = plant_with("drive_gain:factor=1.1").axis.parameters;
    EXPECT_DOUBLE_EQ(effective_voltage_V(axis, 4.0), 0.364 + 0.636 * (4.4 - 3.0));
    EXPECT_GT(effective_voltage_V(axis, 2.8), 0.0);
    EXPECT_EQ(effective_voltage_V(axis, 2.7), 0.0);
    EXPECT_DOUBLE_EQ(effective_voltage_V(axis, 9.0), 0.364 + 0.636 * (5.5 - 3.0))
        << "the converter saturates first";
}

TEST(DriveOffset, CarriageAtRest_IsHeldByFriction) {
    const StagePlant plant = plant_with("drive_offset:offset_V=0.5");
    EXPECT_EQ(after(plant, 0.0, 1000).axis.position_mm, 50.0);
    EXPECT_EQ(after(plant, -2.9, 1000).axis.position_mm, 50.0);
    EXPECT_GT(after(plant, 2.6, 100).axis.position_mm, 50.0) << "friction is overcome earlier with the force";
    EXPECT_EQ(after(plant, -3.4, 1000).axis.position_mm, 50.0) << "and later against it";
    EXPECT_DOUBLE_EQ(effective_voltage_V(plant.axis.parameters, 4.0), 0.364 + 0.636 * 1.5);
    EXPECT_DOUBLE_EQ(effective_voltage_V(plant.axis.parameters, -4.0), -(0.364 + 0.636 * 0.5));
}

TEST(ViscousFriction, Motion_SolvesTheEquationWithTheAddedForce) {
    constexpr double damping_V_s_per_mm = 0.002;
    const StagePlant plant = plant_with("viscous_friction:damping_V_s_per_mm=0.002");
    const MacroAxisParameters nominal = macro_axis_parameters(reference_rig());
    const double voltage_V = effective_voltage_V(nominal, 4.0);
    double position_mm = 50.0, v = 0.0;
    constexpr double step_s = 1e-7;
    for (int k = 0; k < 500000; ++k) {
        const double before = v;
        v += step_s / nominal.time_constant_s *
             (nominal.velocity_gain_mm_per_s_per_V * (voltage_V - damping_V_s_per_mm * v) - v);
        position_mm += 0.5 * step_s * (before + v);
    }
    const StageState state = after(plant, 4.0, 50);
    EXPECT_NEAR(state.axis.velocity_mm_per_s, v, 1e-3);
    EXPECT_NEAR(state.axis.position_mm, position_mm, 1e-4);
}

TEST(Payload, MoreMass_StretchesTimeAndKeepsTheGain) {
    const StagePlant plant = plant_with("payload:mass_factor=1.5");
    const MacroAxisParameters nominal = macro_axis_parameters(reference_rig());
    const double terminal = nominal.velocity_gain_mm_per_s_per_V * effective_voltage_V(nominal, 4.0);
    const double expected = terminal * (1.0 - std::exp(-0.05 / (1.5 * nominal.time_constant_s)));
    EXPECT_NEAR(after(plant, 4.0, 50).axis.velocity_mm_per_s, expected, 1e-9);
}

TEST(EncoderScale, Count_IsLonger) {
    const StagePlant plant = plant_with("encoder_scale:factor=1.01");
    StageState state = start(plant, 101.0, 1, EncoderOrigin::end_of_travel);
    EXPECT_EQ(sample(plant, state).encoder_count, 2000);
}

}  // namespace
}  // namespace fidservo::plant
