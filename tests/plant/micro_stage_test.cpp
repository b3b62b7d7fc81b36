#include "plant/micro_stage.h"

#include "tests/plant/reference_rig.h"

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

}  // namespace
}  // namespace fidservo::plant
