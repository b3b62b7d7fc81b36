// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas that push the motion back hard, or jump with the speed, against closed forms.
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"
#include "plant/stage_plant.h"
#include "tests/plant/formulas/texts.h"
#include "tests/plant/reference_rig.h"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

constexpr double gain = 198.848, tick_s = 0.001;  // K of the reference rig

MacroAxisParameters axis_with(bool with_dead_zone, const std::vector<EffectSetting>& effects) {
    Rig rig = macro_only_rig();
    rig.macro.low_mm = -1e6;
    rig.macro.high_mm = 1e6;
    if (!with_dead_zone) rig.macro.dead_zone = {.threshold_V = 0.0, .offset_V = 0.0, .slope = 1.0};
    PlantParameters parameters = plant_parameters(rig);
    apply_effects(parameters, effects);
    return parameters.axis;
}

EffectSetting formula_at(const std::string& port, const std::string& formula,
                         const std::vector<Number>& numbers) {
    return typical_setting(effect_of(formula_text(port, "macro.friction", formula, numbers)));
}

MacroAxis axis_of(bool with_dead_zone, const EffectSetting& effect) {
    return make_macro_axis(axis_with(with_dead_zone, {effect}), tick_s);
}

MacroAxisState moving(const MacroAxis& axis, double mm_per_s) {
    MacroAxisState state = start(axis, 0.0);
    state.velocity_mm_per_s = mm_per_s;
    return state;
}

/// Way and speed of tau v' = K (pull - c v) - v from a speed.
struct Relaxation {
    double tau_s, terminal_mm_per_s, start_mm_per_s;

    double way_mm(double t_s) const {
        return terminal_mm_per_s * t_s -
               (start_mm_per_s - terminal_mm_per_s) * tau_s * std::expm1(-t_s / tau_s);
    }
    double speed_mm_per_s(double t_s) const {
        return terminal_mm_per_s + (start_mm_per_s - terminal_mm_per_s) * std::exp(-t_s / tau_s);
    }
};

void expect_relaxation(const MacroAxis& axis, double command_V, const Relaxation& exact,
                       const std::string& what) {
    MacroAxisState state = moving(axis, exact.start_mm_per_s);
    for (int tick = 1; tick <= 200; ++tick) {
        (void)advance(axis, state, command_V);
        ASSERT_NEAR(state.position_mm, exact.way_mm(tick * tick_s), 1e-6) << what << " tick " << tick;
        ASSERT_NEAR(state.velocity_mm_per_s, exact.speed_mm_per_s(tick * tick_s), 1e-5) << what;
    }
}

TEST(StiffFormulas, ViscousForceOfAnySize_HasTheExponentialOfItsTimeConstant) {
    const double tau_s = axis_with(false, {}).time_constant_s;
    for (const double c : {1e-4, 1e-2, 1.0, 1e2, 1e4}) {
        const double shorter = 1.0 + gain * c;
        for (const char* port : {"macro.force", "macro.friction"})
            for (const double command_V : {3.0, -3.0}) {
                const MacroAxis axis = axis_of(
                    false, formula_at(port, std::string(port) == "macro.force" ? "-c * speed" : "c * speed",
                                      {{"c", c}}));
                const double k = axis.parameters.velocity_gain_mm_per_s_per_V;
                expect_relaxation(axis, command_V,
                                  {tau_s / (1.0 + k * c), k * command_V / (1.0 + k * c), 0.0},
                                  std::string(port) + " c " + std::to_string(c));
                if (c <= 1.0)
                    expect_relaxation(axis, 0.0, {tau_s / (1.0 + k * c), 0.0, -50.0 / shorter}, port);
            }
    }
}

TEST(StiffFormulas, ViscousFriction_IsThatOfTheCatalogue) {
    const Effect& listed = *find_effect("viscous_friction");
    ASSERT_EQ(listed.parameters.size(), 1u);
    for (const double c : {0.5 * listed.parameters[0].high, listed.parameters[0].high}) {
        const MacroAxis by_list = make_macro_axis(axis_with(true, {{&listed, {c}}}), tick_s);
        const MacroAxis by_formula = axis_of(true, formula_at("macro.friction", "c * speed", {{"c", c}}));
        MacroAxisState left = start(by_list, 0.0), right = start(by_formula, 0.0);
        for (int tick = 0; tick < 500; ++tick) {
            const double command_V = 4.5 * std::sin(0.05 * tick);
            (void)advance(by_list, left, command_V);
            (void)advance(by_formula, right, command_V);
            ASSERT_NEAR(left.position_mm, right.position_mm, 1e-5) << c << ' ' << tick;
        }
    }
}

/// A viscous force leaves so much of the command that the dead zone's edge is met; there the drive's voltage
/// jumps, and the carriage moves on at the speed at which the command just reaches the edge.
TEST(StiffFormulas, ViscousForceBehindTheDeadZone_MovesAlongItsEdge) {
    for (const double c : {0.05, 1.0, 100.0})
        for (const double command_V : {4.5, -4.0}) {
            const MacroAxis axis = axis_of(true, formula_at("macro.force", "-c * speed", {{"c", c}}));
            const double k = axis.parameters.velocity_gain_mm_per_s_per_V,
                         side = command_V < 0.0 ? -1.0 : 1.0;
            const DeadZone& zone = axis.parameters.dead_zone;
            const double beyond_V = std::abs(command_V) - zone.threshold_V, edge_mm_per_s = beyond_V / c;
            const double damped = 1.0 + k * zone.slope * c;
            const Relaxation outside{axis.parameters.time_constant_s / damped,
                                     k * (zone.offset_V + zone.slope * beyond_V) / damped, 0.0};
            ASSERT_GT(outside.terminal_mm_per_s, edge_mm_per_s);
            ASSERT_LT(edge_mm_per_s, k * zone.offset_V) << "less than the jump sustains";
            const double until_s = -outside.tau_s * std::log1p(-edge_mm_per_s / outside.terminal_mm_per_s);
            MacroAxisState state = start(axis, 0.0);
            for (int tick = 1; tick <= 300; ++tick) {
                (void)advance(axis, state, command_V);
                const double t_s = tick * tick_s;
                const double way_mm = t_s < until_s
                                          ? outside.way_mm(t_s)
                                          : outside.way_mm(until_s) + edge_mm_per_s * (t_s - until_s);
                ASSERT_NEAR(side * state.position_mm, way_mm, 1e-5) << c << " tick " << tick;
                if (t_s > until_s) {
                    ASSERT_NEAR(side * state.velocity_mm_per_s, edge_mm_per_s, 1e-5) << c;
                }
            }
        }
}

/// The edge moves with the command, and the carriage comes to it and leaves it in the middle of ticks.
TEST(StiffFormulas, CommandThatSwings_IsFollowedAlongTheEdge) {
    for (const double c : {5.0, 50.0}) {
        const MacroAxis axis = axis_of(true, formula_at("macro.force", "-c * speed", {{"c", c}}));
        MacroAxisState state = start(axis, 0.0);
        for (int tick = 0; tick < 4000; ++tick) {
            const double command_V = 4.5 * std::sin(0.002 * tick), beyond_V = std::abs(command_V) - 3.0;
            (void)advance(axis, state, command_V);
            if (beyond_V > 0.3) {
                ASSERT_NEAR(state.velocity_mm_per_s, std::copysign(beyond_V / c, command_V), 1e-6) << tick;
            }
        }
    }
}

/// Where less than the jump sustains the speed the carriage leaves the edge: it goes slower and slower.
TEST(StiffFormulas, DeadZoneThatNoLongerDrives_LetsTheCarriageCoast) {
    const MacroAxis axis = axis_of(true, formula_at("macro.force", "-c * speed", {{"c", 0.01}}));
    const double tau_s = axis.parameters.time_constant_s, start_mm_per_s = 190.0;
    MacroAxisState state = moving(axis, start_mm_per_s);
    // 4 V less 0.01 V s/mm times more than 100 mm/s is inside the dead zone.
    for (int tick = 1; tick <= 15; ++tick) {
        (void)advance(axis, state, 4.0);
        ASSERT_NEAR(state.velocity_mm_per_s, start_mm_per_s * std::exp(-tick * tick_s / tau_s), 1e-5);
    }
}

TEST(StiffFormulas, SignOfTheSpeedAtTheForce_HoldsSlidesAndStopsLikeFriction) {
    for (const char* law : {"-level * sign(speed)", "-level * direction"}) {
        const MacroAxis axis = axis_of(false, formula_at("macro.force", law, {{"level", 2.0}}));
        const double k = axis.parameters.velocity_gain_mm_per_s_per_V,
                     tau_s = axis.parameters.time_constant_s;
        for (const double side : {-1.0, 1.0}) {
            MacroAxisState state = start(axis, 0.0);
            for (int tick = 0; tick < 100; ++tick) (void)advance(axis, state, side * 1.9);
            EXPECT_EQ(state.position_mm, 0.0) << law << " holds to side " << side;
            expect_relaxation(axis, side * 3.0, {tau_s, side * k, 0.0}, law);
            // From side * 50 mm/s without a command: brakes towards -side * 2 K, and stops where it reaches
            // 0.
            const Relaxation braking{tau_s, -side * 2.0 * k, side * 50.0};
            const double stops_s = tau_s * std::log1p(50.0 / (2.0 * k));
            state = moving(axis, side * 50.0);
            for (int tick = 0; tick < 100; ++tick) (void)advance(axis, state, 0.0);
            EXPECT_NEAR(state.position_mm, braking.way_mm(stops_s), 1e-6);
            EXPECT_EQ(state.velocity_mm_per_s, 0.0);
        }
    }
}

TEST(StiffFormulas, SignOfTheSpeedBeforeTheDeadZone_MovesBothWaysAlike) {
    const MacroAxis axis = axis_of(true, formula_at("macro.force", "-level * sign(speed)", {{"level", 1.0}}));
    MacroAxisState left = start(axis, 0.0), right = start(axis, 0.0);
    for (int tick = 0; tick < 600; ++tick) {
        const double command_V = 5.0 * std::sin(0.03 * tick);
        (void)advance(axis, left, -command_V);
        (void)advance(axis, right, command_V);
        ASSERT_EQ(left.position_mm, -right.position_mm) << tick;
    }
    EXPECT_GT(std::abs(right.position_mm), 1.0);
}

TEST(StiffFormulas, SteepLawAboutRest_CreepsAsItsSlopeSays) {
    for (const double width : {1e-2, 1e-6}) {
        const MacroAxis axis = axis_of(false, formula_at("macro.friction", "level * tanh(speed / width)",
                                                         {{"level", 2.0}, {"width", width, "shape"}}));
        MacroAxisState state = start(axis, 0.0);
        for (int tick = 0; tick < 200; ++tick) (void)advance(axis, state, 1.0);
        EXPECT_NEAR(state.velocity_mm_per_s, width * std::atanh(0.5), 1e-4 * width + 1e-9) << width;
        for (int tick = 0; tick < 200; ++tick) (void)advance(axis, state, 3.0);
        EXPECT_NEAR(state.velocity_mm_per_s,
                    axis.parameters.velocity_gain_mm_per_s_per_V *
                        -std::expm1(-0.2 / axis.parameters.time_constant_s),
                    2e-1)
            << width;
    }
}

/// A law that jumps at a speed other than 0 keeps the carriage at that speed while neither side wins.
TEST(StiffFormulas, JumpAtASpeed_KeepsThatSpeed) {
    const MacroAxis axis =
        axis_of(false, formula_at("macro.friction", "level * sign(speed - 10)", {{"level", 2.0}}));
    MacroAxisState state = start(axis, 0.0);
    for (int tick = 0; tick < 50; ++tick) (void)advance(axis, state, 1.0);
    EXPECT_NEAR(state.velocity_mm_per_s, 10.0, 1e-6);
    const double before_mm = state.position_mm;
    for (int tick = 0; tick < 100; ++tick) (void)advance(axis, state, -0.5);
    EXPECT_NEAR(state.position_mm - before_mm, 1.0, 1e-6);
    for (int tick = 0; tick < 2000; ++tick) {
        (void)advance(axis, state, 1.5 * std::sin(0.01 * tick));
        ASSERT_NEAR(state.velocity_mm_per_s, 10.0, 1e-5) << tick;
    }
}

TEST(StiffFormulas, ForcesAgainstTheMotion_GiveNoEnergy) {
    for (const char* law :
         {"-c * speed", "-c * speed * abs(speed)", "-c * sign(speed) * sqrt(abs(speed))",
          "-c * tanh(1000 * speed)", "-c * atan2(speed, 0.001)", "-c * speed * exp(-speed^2)"})
        for (const double c : {0.001, 0.2, 6.0})
            for (const bool with_dead_zone : {false, true}) {
                const MacroAxis axis = axis_of(with_dead_zone, formula_at("macro.force", law, {{"c", c}}));
                MacroAxisState state = moving(axis, 3.7);
                double before = 3.7;
                for (int tick = 0; tick < 100; ++tick) {
                    (void)advance(axis, state, 0.0);
                    ASSERT_LE(std::abs(state.velocity_mm_per_s), before) << law << ' ' << c << ' ' << tick;
                    before = std::abs(state.velocity_mm_per_s);
                }
            }
}

TEST(StiffFormulas, ViscousFrictionBesideABelt_LeavesItsTerminalVelocity) {
    EffectSetting belt = typical_setting(*find_effect("belt_compliance"));
    for (const double c : {0.01, 1.0, 100.0}) {
        const MacroAxis axis = make_macro_axis(
            axis_with(false, {belt, formula_at("macro.friction", "c * speed", {{"c", c}})}), tick_s);
        ASSERT_TRUE(axis.has_belt);
        const double k = axis.parameters.velocity_gain_mm_per_s_per_V;
        MacroAxisState state = start(axis, 0.0);
        for (int tick = 0; tick < 2000; ++tick) (void)advance(axis, state, 2.0);
        EXPECT_NEAR(state.velocity_mm_per_s, 2.0 * k / (1.0 + k * c), 1e-4 / c) << c;
    }
}

}  // namespace
}  // namespace fidservo::plant
