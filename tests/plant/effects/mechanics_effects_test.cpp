// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/input_error.h"
#include "tests/plant/allocation_count.h"
#include "tests/plant/effects/effect_rig.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

constexpr double gain = 198.84809;  // mm/s/V

TEST(DriveDelay, StepResponse_IsShiftedByAnyTime) {
    const MacroAxis axis = endless_axis_with("drive_delay:delay_ms=3.7");
    MacroAxisState state = start(axis, 0.0);
    const double tau_s = axis.parameters.time_constant_s;
    for (int k = 1; k <= 200; ++k) {
        advance(axis, state, 1.0);
        const double t_s = std::max(0.0, 1e-3 * k - 3.7e-3);
        ASSERT_NEAR(state.position_mm, gain * (t_s - tau_s * (1.0 - std::exp(-t_s / tau_s))), 1e-6);
    }
}

TEST(Cogging, FreeCarriage_ComesToRestWhereTheForceTurnsItBack) {
    const MacroAxis axis = endless_axis_with("cogging:amplitude_V=0.1,period_mm=5");
    EXPECT_NEAR(after(axis, start(axis, 1.5), 0.0, 4000).position_mm, 2.5, 1e-6);
}

/// A wave of which the carriage crosses a hundred thousand periods between two ticks.
TEST(Cogging, TooFineToBeFollowed_IsRefused) {
    PlantParameters plant = plant_parameters(macro_only_rig());
    plant.axis.dead_zone = {};
    plant.axis.standing.cogging_V = 1.0;
    plant.axis.standing.cogging_period_mm = 1e-6;
    const MacroAxis axis = make_macro_axis(plant.axis, plant.tick_s);
    MacroAxisState state = start(axis, 100.0);
    state.velocity_mm_per_s = 100.0;
    EXPECT_THROW(advance(axis, state, 0.0), InputError);
}

TEST(Cogging, CarriageInTheDeadZone_IsHeld) {
    const MacroAxis axis = endless_axis_with("cogging:amplitude_V=0.1,period_mm=5", true);
    EXPECT_EQ(after(axis, start(axis, 1.25), 2.89, 1000).position_mm, 1.25);
    EXPECT_GT(after(axis, start(axis, 1.25), 2.91, 10).position_mm, 1.25);
    EXPECT_EQ(after(axis, start(axis, 3.75), 3.09, 1000).position_mm, 3.75);
}

TEST(CableForce, FreeCarriage_SettlesWhereTheSpringBalancesTheVoltage) {
    const MacroAxis axis = endless_axis_with("cable_force:stiffness_V_per_mm=0.02,centre_mm=100");
    EXPECT_NEAR(after(axis, start(axis, 90.0), 0.4, 6000).position_mm, 120.0, 1e-5);
}

/// 0.01 d (1 + 2 (d / 100 mm)^2) = 1.5, that is d^3 + 5000 d - 750000 = 0: Cardano.
TEST(CableForce, SpringThatHardens_IsBalancedByTheRootOfItsCubic) {
    const MacroAxis axis = endless_axis_with("cable_force:stiffness_V_per_mm=0.01,centre_mm=100,hardening=2");
    const double half = 375000.0, root = std::sqrt(half * half + std::pow(5000.0 / 3.0, 3));
    const double expected = std::cbrt(half + root) + std::cbrt(half - root);
    EXPECT_NEAR(after(axis, start(axis, 170.0), 1.5, 6000).position_mm, 100.0 + expected, 1e-4);
}

TEST(BeltCompliance, Swing_HasTheStatedFrequencyAndDamping) {
    const MacroAxis axis = endless_axis_with("belt_compliance:stretch_um_per_V=50,damping_ratio=0.05");
    const double w = natural_frequency_rad_per_s(axis.parameters.belt, gain, axis.parameters.time_constant_s);
    // The motor's back-EMF adds 1/(2 tau) to the oscillation's damping, as half of the motion is the motor's.
    const double decay = 0.05 * w + 0.5 / axis.parameters.time_constant_s;
    const double swing = w * std::sqrt(1.0 - 0.05 * 0.05);
    MacroAxisState state = start(axis, 0.0);
    state.mechanism.stretch_mm = 0.1;
    const int ticks = static_cast<int>(std::lround(4.0 * std::numbers::pi / swing * 1e3));
    state = after(axis, state, 0.0, ticks);
    const double expected = 0.1 * std::exp(-decay * 1e-3 * ticks) * std::cos(swing * 1e-3 * ticks);
    EXPECT_NEAR(state.mechanism.stretch_mm, expected, 0.1 * 0.05);
}

TEST(BeltCompliance, SteadyMotion_IsThatOfTheStiffAxis) {
    const MacroAxis axis = endless_axis_with("belt_compliance");
    EXPECT_NEAR(after(axis, start(axis, 0.0), 0.5, 2000).velocity_mm_per_s, gain * 0.5, 1e-5);
}

TEST(Backlash, Carriage_FollowsThePlayOperatorOfTheStiffMotion) {
    const MacroAxis axis = endless_axis_with("backlash:width_um=400", true);
    const MacroAxis stiff = endless_axis_with("backlash:width_um=0", true);
    MacroAxisState state = start(axis, 0.0), driven = start(stiff, 0.0);
    double carriage_mm = 0.0;
    for (int k = 0; k < 3000; ++k) {
        const double command_V = 4.5 * std::sin(0.01 * k);
        advance(axis, state, command_V);
        advance(stiff, driven, command_V);
        carriage_mm = std::clamp(carriage_mm, driven.position_mm - 0.2, driven.position_mm + 0.2);
        ASSERT_NEAR(state.position_mm, carriage_mm, 1e-4)
            << "a turn within a tick is sampled up to that late";
    }
}

TEST(EncoderRipple, Reading_HasTheStatedError) {
    const StagePlant plant = plant_with("encoder_ripple:amplitude_um=500,period_mm=5");
    StageState state = start(plant, 101.25, 1, EncoderOrigin::end_of_travel);
    EXPECT_EQ(sample(plant, state).encoder_count, 2035);
    state = start(plant, 103.75, 1, EncoderOrigin::end_of_travel);
    EXPECT_EQ(sample(plant, state).encoder_count, 2065);
}

std::vector<EffectSetting> all_of_the_macro_stage() {
    std::vector<EffectSetting> effects;
    for (const Effect* effect : effect_catalogue())
        if (effect->block.starts_with("macro.")) effects.push_back(parse_effect(effect->name));
    return effects;
}

double after_three_seconds_mm(MacroAxis axis, double longest_step_s) {
    axis.longest_step_s = std::min(axis.longest_step_s, longest_step_s);
    MacroAxisState state = start(axis, 60.0);
    for (int k = 0; k < 3000; ++k)
        advance(axis, state, 3.4 * std::sin(0.013 * k) + 0.8 * std::sin(0.0031 * k * k / 50.0));
    return state.position_mm;
}

TEST(Mechanism, HundredTimesFinerSteps_GiveTheSameMotion) {
    constexpr double hundredth_count_mm = 5e-4;
    std::vector<std::string> effects{"stribeck_friction:level_V=0.4,creep_mm_per_s=0.04"};
    for (const Effect* effect : effect_catalogue())
        if (effect->block.starts_with("macro.")) effects.emplace_back(effect->name);
    for (const std::string& effect : effects) {
        const MacroAxis axis = plant_with(effect).axis;
        EXPECT_NEAR(after_three_seconds_mm(axis, 1.0), after_three_seconds_mm(axis, 1e-5), hundredth_count_mm)
            << effect;
    }
    const MacroAxis all = make_stage_plant(reference_rig(), all_of_the_macro_stage()).axis;
    EXPECT_NEAR(after_three_seconds_mm(all, 1.0), after_three_seconds_mm(all, 1e-5), hundredth_count_mm);
}

TEST(Mechanism, ForcesAlongTheRail_MoveInSeriesAsWhenIntegrated) {
    constexpr double thousandth_count_mm = 5e-5;
    for (const std::string_view effect : {"cogging:amplitude_V=0.15,second_sine=0.3",
                                          "cogging:amplitude_V=0.004", "cable_force:hardening=3"}) {
        MacroAxis integrated = endless_axis_with(effect, true);
        ASSERT_TRUE(integrated.has_series) << effect;
        integrated.has_series = false;
        const MacroAxis in_series = endless_axis_with(effect, true);
        MacroAxisState one = start(in_series, 60.0), other = start(integrated, 60.0);
        StepCount steps, other_steps;
        for (int k = 0; k < 5000; ++k) {
            const double command_V = 4.0 * std::sin(0.0025 * k) + 1.2 * std::sin(0.0107 * k);
            steps += advance(in_series, one, command_V);
            other_steps += advance(integrated, other, command_V);
            ASSERT_NEAR(one.position_mm, other.position_mm, thousandth_count_mm) << effect << ", " << k;
        }
        EXPECT_EQ(steps.integrated, 0) << effect;
        EXPECT_EQ(other_steps.in_series, 0) << effect;
        EXPECT_GT(steps.in_series, 1000) << effect;
    }
}

TEST(Mechanism, EndOfTravel_StopsTheCarriageDeadWhateverTheEffects) {
    const StagePlant plant = make_stage_plant(reference_rig(), all_of_the_macro_stage());
    StageState state = start(plant, 190.0, 1);
    for (int k = 0; k < 2000; ++k) {
        advance(plant, state, 5.0, 0.0);
        ASSERT_LE(state.axis.position_mm, 200.0);
    }
    EXPECT_EQ(state.axis.position_mm, 200.0);
    EXPECT_EQ(state.axis.velocity_mm_per_s, 0.0);
    for (int k = 0; k < 500; ++k) advance(plant, state, -5.0, 0.0);
    EXPECT_LT(state.axis.position_mm, 190.0);
}

/// The motor still oscillates on the belt: the integration must not end up with steps that no longer move the
/// carriage.
TEST(Mechanism, CarriageThatRunsIntoTheEndItStandsAt_TakesFewSteps) {
    const MacroAxis axis = plant_with("belt_compliance").axis;
    for (const double side : {-1.0, 1.0}) {
        MacroAxisState state = start(axis, side < 0.0 ? 0.0 : 200.0);
        state.velocity_mm_per_s = side * 2e-4;
        state.mechanism.stretching_mm_per_s = side * 0.015;
        const double at_mm = state.position_mm;
        EXPECT_LT(advance(axis, state, side * 3.1).integrated, 100) << side;
        EXPECT_EQ(state.position_mm, at_mm);
        EXPECT_EQ(state.velocity_mm_per_s, 0.0);
    }
}

TEST(Mechanism, Tick_DoesNotAllocate) {
    const StagePlant plant = make_stage_plant(reference_rig(), all_of_the_macro_stage());
    StageState state = start(plant, 100.0, 1);
    const long before = allocation_count();
    for (int k = 0; k < 20000; ++k) advance(plant, state, 5.0 * std::sin(0.01 * k), 0.0);
    EXPECT_EQ(allocation_count() - before, 0);
}

}  // namespace
}  // namespace fidservo::plant
