// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/dead_zone.h"
#include "core/macro_parameters.h"
#include "plant/spring_motion.h"
#include "tests/plant/effects/effect_rig.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

constexpr double gain = 198.84809;  // mm/s/V

TEST(CoulombFriction, CoastingCarriage_StopsAfterTheAnalyticWayAndStays) {
    const MacroAxis axis = endless_axis_with("coulomb_friction:level_V=0.1");
    const double tau_s = axis.parameters.time_constant_s, drag = gain * 0.1;
    for (const double v0 : {200.0, -35.0, 1.0}) {
        MacroAxisState state = start(axis, 0.0);
        state.velocity_mm_per_s = v0;
        state = after(axis, state, 0.0, 500);
        const double way_mm = tau_s * (std::abs(v0) - drag * std::log1p(std::abs(v0) / drag));
        EXPECT_NEAR(state.position_mm, std::copysign(way_mm, v0), 1e-6);
        EXPECT_EQ(state.velocity_mm_per_s, 0.0);
        EXPECT_EQ(after(axis, state, 0.0999, 100).position_mm, state.position_mm);
        EXPECT_GT(after(axis, state, 0.1001, 100).position_mm, state.position_mm);
    }
}

TEST(CoulombFriction, SteadySpeed_IsThatOfTheVoltageBeyondIt) {
    const MacroAxis axis = endless_axis_with("coulomb_friction:level_V=0.1");
    for (const double voltage_V : {0.15, 1.0, -2.0}) {
        const double net_V = voltage_V - std::copysign(0.1, voltage_V);
        EXPECT_NEAR(after(axis, start(axis, 0.0), voltage_V, 1500).velocity_mm_per_s, gain * net_V, 1e-5);
    }
}

TEST(CoulombFriction, OnlyCoasting_BrakesWhereTheDriveHasNoVoltageAndNowhereElse) {
    const MacroAxis axis =
        endless_axis_with("coulomb_friction:level_V=0,dead_zone_share=0.05,only_coasting=1", true);
    const MacroAxis nominal = endless_axis_with("coulomb_friction:level_V=0,dead_zone_share=0", true);
    const DeadZone& zone = axis.parameters.dead_zone;
    for (const double command_V : {3.5, -5.0}) {
        const MacroAxisState driven = after(axis, start(axis, 0.0), command_V, 400),
                             as_driven = after(nominal, start(nominal, 0.0), command_V, 400);
        EXPECT_NEAR(driven.position_mm, as_driven.position_mm, 1e-6);
        // If it is commanded back while it moves, it counts as driven, too.
        EXPECT_NEAR(after(axis, driven, -command_V, 20).position_mm,
                    after(nominal, as_driven, -command_V, 20).position_mm, 1e-6);

        const double v0 = std::abs(driven.velocity_mm_per_s), tau_s = axis.parameters.time_constant_s;
        const double drag = gain * 0.05 * (zone.slope * zone.threshold_V - zone.offset_V);
        const double way_mm = tau_s * (v0 - drag * std::log1p(v0 / drag));
        for (const double within_V : {0.0, 0.9 * zone.threshold_V})
            EXPECT_NEAR(std::abs(after(axis, driven, within_V, 500).position_mm - driven.position_mm), way_mm,
                        1e-5);
    }
}

TEST(CoulombFriction, OnlyCoasting_HoldsWhatABeltPullsAtRest) {
    const EffectSetting effects[] = {
        parse_effect("coulomb_friction:level_V=0,dead_zone_share=0.05,only_coasting=1"),
        parse_effect("belt_compliance:stretch_um_per_V=100")};
    const MacroAxis axis = endless_axis_with(effects, true);
    MacroAxisState state = after(axis, start(axis, 0.0), 4.0, 100);
    int steps = 0;
    for (int k = 0; k < 500; ++k) steps += advance(axis, state, 0.0).integrated;
    EXPECT_EQ(state.velocity_mm_per_s, 0.0);
    EXPECT_LT(steps, 500 * 100);
}

TEST(StribeckFriction, SteadySpeed_LiesOnTheCurve) {
    const MacroAxis axis = endless_axis_with("stribeck_friction:level_V=0.2,speed_mm_per_s=12");
    for (const double voltage_V : {0.21, 0.4, -1.0}) {
        const double v = after(axis, start(axis, 0.0), voltage_V, 2000).velocity_mm_per_s;
        EXPECT_NEAR(v, gain * (voltage_V - std::copysign(0.2 * std::exp(-std::abs(v) / 12.0), v)), 1e-4);
    }
    EXPECT_EQ(after(axis, start(axis, 0.0), 0.1999, 100).position_mm, 0.0) << "held";
}

TEST(StribeckFriction, WithExponent_LiesOnThatCurve) {
    for (const double exponent : {1.5, 2.0, 3.0}) {
        const MacroAxis axis = endless_axis_with("stribeck_friction:level_V=0.2,speed_mm_per_s=12,exponent=" +
                                                 std::to_string(exponent));
        for (const double voltage_V : {0.21, -0.4}) {
            const double v = after(axis, start(axis, 0.0), voltage_V, 3000).velocity_mm_per_s;
            const double dry_V = 0.2 * std::exp(-std::pow(std::abs(v) / 12.0, exponent));
            EXPECT_NEAR(v, gain * (voltage_V - std::copysign(dry_V, v)), 1e-3) << exponent;
        }
    }
}

TEST(StribeckFriction, WithCreepSpeed_LetsTheCarriageCreepWhereItWouldHold) {
    const MacroAxis axis =
        endless_axis_with("stribeck_friction:level_V=0.2,speed_mm_per_s=12,creep_mm_per_s=0.4");
    const double v = after(axis, start(axis, 0.0), 0.1, 500).velocity_mm_per_s;
    EXPECT_GT(v, 0.05);
    EXPECT_NEAR(v, gain * (0.1 - 0.2 * std::exp(-v / 12.0) * std::tanh(v / 0.4)), 1e-5);
}

/// At low and at high speed, and also where sliding has a closed form.
TEST(CoulombFriction, WithCreepSpeed_CreepsBelowItsLevelAndSlidesAsWithoutAboveIt) {
    const MacroAxis creeping = endless_axis_with("coulomb_friction:level_V=0.2,creep_mm_per_s=0.4");
    const MacroAxis rigid = endless_axis_with("coulomb_friction:level_V=0.2");
    const double v = after(creeping, start(creeping, 0.0), 0.1, 500).velocity_mm_per_s;
    EXPECT_NEAR(v, gain * (0.1 - 0.2 * std::tanh(v / 0.4)), 1e-5);
    const MacroAxisState fast = after(creeping, start(creeping, 0.0), 1.0, 300);
    EXPECT_NEAR(fast.velocity_mm_per_s, after(rigid, start(rigid, 0.0), 1.0, 300).velocity_mm_per_s, 1e-6);
    EXPECT_NEAR(after(creeping, fast, 0.5, 500).position_mm - fast.position_mm,
                after(rigid, fast, 0.5, 500).position_mm - fast.position_mm, 1e-6);
}

TEST(RailPatch, WithCreepSpeed_CreepsOverThePlace) {
    const MacroAxis axis =
        endless_axis_with("rail_patch:level_V=0.2,centre_mm=0,width_mm=50,creep_mm_per_s=0.4");
    const double v = after(axis, start(axis, 0.0), 0.1, 500).velocity_mm_per_s;
    EXPECT_GT(v, 0.2);
    EXPECT_NEAR(v, gain * (0.1 - 0.2 * std::tanh(v / 0.4)), 1e-4);
}

TEST(FrictionEffects, ThatCreepTogether_CreepAsTheFastest) {
    PlantParameters plant = plant_parameters(reference_rig());
    const std::vector<EffectSetting> both{parse_effect("coulomb_friction:creep_mm_per_s=0.4"),
                                          parse_effect("rail_patch:creep_mm_per_s=0.9")};
    apply_effects(plant, both);
    EXPECT_EQ(plant.axis.friction.creep_mm_per_s, 0.9);
}

TEST(FrictionAsymmetry, SteadySpeed_DependsOnTheDirection) {
    const MacroAxis axis =
        endless_axis_with("friction_asymmetry:right_V_s_per_mm=0.001,left_V_s_per_mm=-0.0005");
    EXPECT_NEAR(after(axis, start(axis, 0.0), 1.0, 1500).velocity_mm_per_s, gain / (1.0 + 0.001 * gain),
                1e-5);
    EXPECT_NEAR(after(axis, start(axis, 0.0), -1.0, 1500).velocity_mm_per_s, -gain / (1.0 - 0.0005 * gain),
                1e-5);
}

TEST(Presliding, BelowBreakAway_BristlesBendAsTheForceDemandsAndSpringBack) {
    const MacroAxis axis =
        endless_axis_with("presliding:level_V=0.1,distance_um=20,damping_V_s_per_mm=0.005");
    MacroAxisState state = start(axis, 0.0);
    for (int k = 0; k < 4000; ++k) advance(axis, state, 0.05 * k / 4000.0);
    state = after(axis, state, 0.05, 1000);
    EXPECT_NEAR(state.position_mm, -0.02 * std::log(1.0 - 0.05 / 0.1), 1e-4)
        << "the ramp's end swings a little";
    EXPECT_NEAR(0.1 * state.mechanism.bristle_bend, 0.05, 1e-6);
    EXPECT_LT(after(axis, state, 0.0, 500).position_mm, state.position_mm - 0.005);
}

TEST(Presliding, LevelThatVanishes_LeavesNoDamping) {
    const MacroAxis axis =
        endless_axis_with("presliding:level_V=1e-7,distance_um=1000,damping_V_s_per_mm=0.05");
    const MacroAxis without = endless_axis_with("presliding:level_V=0");
    EXPECT_NEAR(after(axis, start(axis, 0.0), 0.3, 20).velocity_mm_per_s,
                after(without, start(without, 0.0), 0.3, 20).velocity_mm_per_s, 1e-4);
}

TEST(Presliding, AboveBreakAway_SlidesAgainstTheLevel) {
    const MacroAxis axis = endless_axis_with("presliding:level_V=0.1,distance_um=20");
    EXPECT_LT(after(axis, start(axis, 0.0), 0.04, 1000).position_mm, 0.1);
    EXPECT_NEAR(after(axis, start(axis, 0.0), 0.3, 1500).velocity_mm_per_s, gain * 0.2, 1e-5);
}

/// Against an integration of LuGre's equations with a constant stiffness in steps of 2 us.
TEST(Presliding, BesideOtherFriction_IsLuGreOfConstantStiffness) {
    const std::vector effects{parse_effect("presliding:level_V=0.1,distance_um=200"),
                              parse_effect("rail_patch:level_V=0.08,centre_mm=3,width_mm=2"),
                              parse_effect("stribeck_friction:level_V=0.05,speed_mm_per_s=20")};
    const MacroAxis axis = endless_axis_with(effects);
    MacroAxisState state = start(axis, 0.0);

    constexpr double step_s = 2e-6, stiffness_V_per_mm = 0.1 / 0.2;
    constexpr int steps_per_tick = 500;
    const double tau_s = axis.parameters.time_constant_s;
    double y = 0.0, v = 0.0, bristle = 0.0;
    for (int k = 0; k < 1500; ++k) {
        const double command_V = 0.6 * std::sin(0.012 * k);
        advance(axis, state, command_V);
        for (int i = 0; i < steps_per_tick; ++i) {
            const double away = (y - 3.0) / 2.0;
            const double dry_V =
                0.1 + 0.08 * std::exp(-0.5 * away * away) + 0.05 * std::exp(-std::abs(v) / 20.0);
            const double force_V = stiffness_V_per_mm * bristle;
            bristle += step_s * (v - std::abs(v) * force_V / dry_V);
            v += step_s * (gain * (command_V - force_V) - v) / tau_s;
            y += step_s * v;
        }
        ASSERT_NEAR(state.position_mm, y, 2e-3) << "tick " << k;
    }
}

/// Against an integration in steps of 2 us.
TEST(Presliding, OfSprings_IsElasticUntilItSlides) {
    for (const double damping_V_s_per_mm : {0.0, 0.004}) {
        const MacroAxis axis =
            endless_axis_with("presliding:level_V=0.1,distance_um=200,springs=1,damping_V_s_per_mm=" +
                              std::to_string(damping_V_s_per_mm));
        MacroAxisState state = start(axis, 0.0);
        constexpr double step_s = 2e-6;
        constexpr int steps_per_tick = 500;
        const double tau_s = axis.parameters.time_constant_s;
        double y = 0.0, v = 0.0, bend = 0.0;
        for (int k = 0; k < 800; ++k) {
            const double command_V = 0.15 * std::sin(0.03 * k);
            advance(axis, state, command_V);
            for (int i = 0; i < steps_per_tick; ++i) {
                const bool slides = std::abs(bend) >= 1.0 && bend * v > 0.0;
                const double damping_V = slides ? 0.0 : damping_V_s_per_mm * v;
                bend = std::clamp(bend + step_s * v / 0.2, -1.0, 1.0);
                v += step_s * (gain * (command_V - 0.1 * bend - damping_V) - v) / tau_s;
                y += step_s * v;
            }
            ASSERT_NEAR(state.position_mm, y, 2e-3) << "tick " << k << ", damping " << damping_V_s_per_mm;
        }
    }
}

/// Against an integration in steps of 2 us. While the carriage coasts, friction is larger and springs bend
/// further; they yield when the drive is back.
TEST(Presliding, OfSpringsBesideFrictionOfCoasting_IsElasticUntilItSlides) {
    const std::vector effects{
        parse_effect("presliding:level_V=0.1,distance_um=200,springs=1"),
        parse_effect("coulomb_friction:level_V=0,dead_zone_share=0.05,only_coasting=1")};
    const MacroAxis axis = endless_axis_with(effects, true);
    const DeadZone& zone = axis.parameters.dead_zone;
    const double coasting_V = axis.parameters.friction.coasting_V;
    ASSERT_GT(coasting_V, 0.0);
    MacroAxisState state = start(axis, 0.0);
    constexpr double step_s = 2e-6;
    constexpr int steps_per_tick = 500;
    const double tau_s = axis.parameters.time_constant_s;
    double y = 0.0, v = 0.0, bend = 0.0;
    for (int k = 0; k < 800; ++k) {
        const double command_V = 1.6 * zone.threshold_V * std::sin(0.03 * k);
        advance(axis, state, command_V);
        const DeadZoneBranch branch = dead_zone_branch(zone, command_V);
        const double drive_V = dead_zone_V(zone, branch, command_V, axis.parameters.dead_zone_on_motion);
        const double limit = 1.0 + (branch == DeadZoneBranch::inside ? coasting_V / 0.1 : 0.0);
        for (int i = 0; i < steps_per_tick; ++i) {
            const double direction = v < 0.0 ? -1.0 : 1.0, way = step_s * std::abs(v) / 0.2;
            const double before = direction * bend;
            bend =
                direction * (before <= limit ? std::min(limit, before + way) : std::max(limit, before - way));
            v += step_s * (gain * (drive_V - 0.1 * bend) - v) / tau_s;
            y += step_s * v;
        }
        ASSERT_NEAR(state.position_mm, y, 2e-3) << "tick " << k;
    }
}

/// Damping acts on bristles while they bend. Where the friction that falls with speed has nearly vanished,
/// rounding must not decide whether they bend: steps would become as short as possible.
TEST(Presliding, OfDampedSpringsThatSlideBesideStribeckFriction_IsFollowedInFewSteps) {
    const std::vector effects{
        parse_effect("presliding:level_V=0.0065,distance_um=6.5,springs=1,damping_V_s_per_mm=0.05"),
        parse_effect("stribeck_friction:level_V=0.05,speed_mm_per_s=4.8")};
    const MacroAxis axis = endless_axis_with(effects);
    MacroAxisState state = start(axis, 0.0);
    StepCount steps;
    constexpr int ticks = 2000;
    for (int k = 0; k < ticks; ++k) steps += advance(axis, state, 1.5 * std::sin(0.01 * k));
    EXPECT_LT(steps.integrated, 20 * ticks);
    EXPECT_GT(std::abs(state.position_mm), 1.0);
}

/// Within a tick it would oscillate back.
TEST(Presliding, OfStiffSprings_SlidesWhereItIsFast) {
    const MacroAxis axis = endless_axis_with("presliding:level_V=0.1,distance_um=0.1,springs=1");
    const MacroAxis rigid = endless_axis_with("coulomb_friction:level_V=0.1");
    MacroAxisState state = start(axis, 0.0), slid = state;
    state.velocity_mm_per_s = slid.velocity_mm_per_s = 25.0;
    EXPECT_NEAR(after(axis, state, 0.0, 100).position_mm, after(rigid, slid, 0.0, 100).position_mm, 1e-3);
}

/// It reverses several times in a tick.
TEST(Presliding, OfStiffSprings_SwingsAsADampedOscillatorDoes) {
    constexpr double level_V = 0.1, distance_mm = 1e-4, tick_s = 1e-3;
    const MacroAxis axis = endless_axis_with("presliding:level_V=0.1,distance_um=0.1,springs=1");
    const double tau_s = axis.parameters.time_constant_s;
    MacroAxisState state = start(axis, 0.0);
    state.velocity_mm_per_s = 0.2;
    const SpringMotion swing{0.0, gain * level_V / (distance_mm * tau_s), 1.0 / tau_s, 0.2};
    for (int k = 1; k <= 200; ++k) {
        advance(axis, state, 0.0);
        const auto [way_mm, mm_per_s] = swing.after(tick_s * k);
        ASSERT_NEAR(state.position_mm, way_mm, 1e-9) << "tick " << k;
        ASSERT_NEAR(state.velocity_mm_per_s, mm_per_s, 1e-5) << "tick " << k;
    }
}

TEST(Presliding, UnderPulsesOfOneSign_DriftsUnlessBristlesAreSprings) {
    const auto drift_mm = [](const char* effect) {
        const MacroAxis axis = endless_axis_with(effect);
        MacroAxisState state = start(axis, 0.0);
        for (int k = 0; k < 200; ++k) state = after(axis, after(axis, state, 0.09, 1), 0.0, 99);
        return state.position_mm;
    };
    EXPECT_GT(drift_mm("presliding:level_V=0.1,distance_um=20"), 0.02);
    EXPECT_LT(std::abs(drift_mm("presliding:level_V=0.1,distance_um=20,springs=1")), 1e-3);
}

TEST(RailPatch, WithSteepEdges_IsLevelBetweenThem) {
    const Friction friction{.patch = {.level_V = 0.2, .centre_mm = 50.0, .width_mm = 10.0, .exponent = 8.0}};
    EXPECT_NEAR(dry_friction_V(friction, 1.0, 45.0, false), 0.2 * std::exp(-0.5 / 256.0), 1e-12);
    EXPECT_NEAR(dry_friction_V(friction, 1.0, 60.0, false), 0.2 * std::exp(-0.5), 1e-12);
    EXPECT_LT(dry_friction_V(friction, 1.0, 65.0, false), 1e-5);
}

TEST(RailPatch, SteadySpeed_IsLowerOnThePatchOnly) {
    const MacroAxis axis = endless_axis_with("rail_patch:level_V=0.2,centre_mm=500,width_mm=100");
    MacroAxisState state = start(axis, 0.0);
    double slowest = 1e9;
    while (state.position_mm < 1000.0) {
        advance(axis, state, 0.5);
        if (state.position_mm > 100.0) slowest = std::min(slowest, state.velocity_mm_per_s);
    }
    EXPECT_NEAR(state.velocity_mm_per_s, gain * 0.5, 0.1);
    EXPECT_NEAR(slowest, gain * 0.3, 0.5);
}

TEST(FrictionEffects, MirroredCommands_GiveMirroredMotion) {
    for (const char* effect :
         {"coulomb_friction", "stribeck_friction", "presliding", "belt_compliance", "backlash",
          "stribeck_friction:creep_mm_per_s=0.4", "coulomb_friction:creep_mm_per_s=0.4",
          "rail_patch:centre_mm=0,creep_mm_per_s=0.4"}) {
        const MacroAxis axis = endless_axis_with(effect, true);
        MacroAxisState right = start(axis, 0.0), left = right;
        for (int k = 0; k < 3000; ++k) {
            const double command_V = 4.8 * std::sin(0.011 * k) + 0.5 * std::sin(0.17 * k);
            advance(axis, right, command_V);
            advance(axis, left, -command_V);
        }
        EXPECT_NEAR(right.position_mm, -left.position_mm, 1e-9) << effect;
    }
}

}  // namespace
}  // namespace fidservo::plant
