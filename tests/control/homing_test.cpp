// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/homing.h"

#include "core/rig.h"
#include "plant/stage_plant.h"
#include "tests/plant/reference_rig.h"

#include <gtest/gtest.h>

namespace fidservo::control {
namespace {

HomingParams homing_params(const Rig& rig) {
    HomingParams params;
    params.macro = {*rig.macro.pd, rig.macro.command_limit_V, rig.tick_s};
    return params;
}

TEST(Homing, FromAnywhere_FindsTheEndStop) {
    const Rig& rig = reference_rig();
    const plant::StagePlant stage = plant::make_stage_plant(rig);
    for (const double start_mm : {0.0, 0.013, 1.7, 83.021, 200.0}) {
        SCOPED_TRACE(start_mm);
        plant::StageState truth = plant::start(stage, start_mm, 1);
        HomingState homing;
        int ticks = 0;
        for (; homing.phase == HomingPhase::seeking && ticks < 20'000; ++ticks) {
            const auto reading = plant::sample(stage, truth);
            plant::advance(stage, truth, homing_update(homing_params(rig), homing, reading.encoder_count),
                           0.0);
        }
        EXPECT_EQ(homing.phase, HomingPhase::at_stop);
        EXPECT_NEAR(truth.axis.position_mm, 0.0, 1e-9);
        EXPECT_EQ(homing.stop_count, plant::sample(stage, truth).encoder_count);
        EXPECT_LT(ticks, 11'000);
        EXPECT_EQ(homing_update(homing_params(rig), homing, homing.stop_count), 0.0);
    }
}

TEST(Homing, CarriageThatNeverStops_GivesUpWithTheMotorOff) {
    const Rig& rig = reference_rig();
    const HomingParams params = homing_params(rig);
    HomingState homing;
    std::int64_t count = 0;
    double command_V = 1.0;
    for (int k = 0; k < 20'000 && homing.phase == HomingPhase::seeking; ++k)
        command_V = homing_update(params, homing, count -= k % 2);
    EXPECT_EQ(homing.phase, HomingPhase::failed);
    EXPECT_EQ(command_V, 0.0);
}

}  // namespace
}  // namespace fidservo::control
