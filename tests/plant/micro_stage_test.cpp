// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/micro_stage.h"

#include "plant/formulas/formula_code.h"
#include "tests/plant/formulas/texts.h"
#include "tests/plant/reference_rig.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

constexpr double tick_s = 0.001;

MicroStage reference_stage() {
    return make_micro_stage(*micro_stage_parameters(reference_rig()), tick_s);
}

TEST(MicroStage, ColdStart_IsFullyExtended) {
    const MicroStage stage = reference_stage();
    const MicroStageState state = start(stage, 1);
    EXPECT_EQ(state.heater.temp_degC, 22.0);
    EXPECT_NEAR(state.position_mm, 0.0, 0.001);
}

TEST(MicroStage, FullVoltage_GivesTheFullStroke) {
    const MicroStage stage = reference_stage();
    MicroStageState state = start(stage, 1);
    for (int k = 0; k < 10000; ++k) advance(stage, state, 1.9);
    EXPECT_DOUBLE_EQ(state.position_mm, stage.fod->stroke_mm());
    EXPECT_NEAR(state.position_mm, 4.0, 0.02) << "the published stroke";
}

TEST(MicroStage, HeatingFromCold_FollowsTheTablesDiagonal) {
    const MicroStage stage = reference_stage();
    MicroStageState state = start(stage, 1);
    for (int k = 1; k <= 400; ++k) {
        advance(stage, state, 1.7);
        const double temp_degC = 22.0 + 272.0 * 0.4 * (1.0 - std::exp(-k * tick_s / 0.55));
        ASSERT_NEAR(state.position_mm, stage.fod->contraction_mm(temp_degC, temp_degC), 1e-9);
    }
}

TEST(MicroStage, SameCommandFromBothSides_ShowsHysteresis) {
    const MicroStage stage = reference_stage();
    MicroStageState heated = start(stage, 1), cooled = start(stage, 1);
    for (int k = 0; k < 10000; ++k) advance(stage, cooled, 1.9);
    for (int k = 0; k < 20000; ++k) {
        advance(stage, heated, 1.5);
        advance(stage, cooled, 1.5);
    }
    EXPECT_NEAR(heated.heater.temp_degC, cooled.heater.temp_degC, 1e-6);
    EXPECT_GT(cooled.position_mm, heated.position_mm + 0.5);
}

/// A heat loss in proportion to the difference from 10 degC above the room, and a second one behind a lag,
/// which does not matter at rest: x / tau = -0.1 (x - 10).
TEST(MicroStage, FormulaOfHeat_BeginsWhereItLeavesAWireThatStoodForLong) {
    FormulaEffect text =
        formula_text("micro.heat_flow", "micro.heater",
                     "-loss * (wire_temp - room_temp - 10) + (slow - wire_temp)", {{"loss", 0.1}});
    text.memories.push_back({.name = "slow",
                             .kind = FormulaEffect::Memory::Kind::state,
                             .of = "(wire_temp - slow) / 5",
                             .by = {}});
    MicroStageParameters parameters = *micro_stage_parameters(reference_rig());
    parameters.formulas.add(FormulaCode::of(text), std::array{0.1});
    const MicroStage stage = make_micro_stage(parameters, tick_s);
    MicroStageState state = start(stage, 1);
    const double tau_s = parameters.heater.cooling_tau_s;
    const double rise_degC = 10.0 * 0.1 * tau_s / (1.0 + 0.1 * tau_s);
    EXPECT_NEAR(state.heater.temp_degC, parameters.heater.ambient_degC + rise_degC, 1e-6);
    for (int k = 0; k < 5000; ++k) advance(stage, state, 0.0);
    const double of_a_tick_degC = tick_s * rise_degC / tau_s;  // the flow is added at the tick's beginning
    EXPECT_NEAR(state.heater.temp_degC, parameters.heater.ambient_degC + rise_degC, of_a_tick_degC);
}

}  // namespace
}  // namespace fidservo::plant
