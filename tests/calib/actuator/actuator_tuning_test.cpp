// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/actuator_tuning.h"

#include "core/failure.h"
#include "core/result.h"
#include "core/rig.h"
#include "tests/calib/sweep.h"

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

TEST(ActuatorTuning, ActuatorThatDiffersFromItsFile_IsRecovered) {
    const Rig& rig = reference_rig();
    plant::PlantParameters physics = plant::plant_parameters(rig);
    physics.micro->stroke_factor = 0.95;
    physics.micro->heater.ambient_degC += 8.0;
    physics.micro->heater.gain_degC_per_V *= 1.05;
    physics.micro->heater.cooling_tau_s *= 0.9;
    const Sweep sweep = make_sweep(physics, 5);
    const auto tuning =
        tune_actuator(nominal_micro_model(*rig.micro), rig.tick_s, sweep.true_position_mm, sweep.command_V);
    ASSERT_TRUE(tuning) << tuning.error().text;
    EXPECT_NEAR(tuning->stroke_scale, 0.95, 1e-3);
    EXPECT_NEAR(tuning->heater.ambient_degC, 30.0, 0.1);
    EXPECT_NEAR(tuning->heater.gain_degC_per_V, 272.0 * 1.05, 0.5);
    EXPECT_NEAR(tuning->heater.heating_tau_s, 0.55, 0.002);
    EXPECT_NEAR(tuning->heater.cooling_tau_s, 0.9, 0.002);
    EXPECT_LT(tuning->residual_mm, 1e-4);
}

TEST(ActuatorTuning, WireThatStaysCold_IsRefused) {
    const Rig& rig = reference_rig();
    const Sweep sweep = make_sweep(plant::plant_parameters(rig), 5, 0.0, 0.2);
    const auto tuning =
        tune_actuator(nominal_micro_model(*rig.micro), rig.tick_s, sweep.true_position_mm, sweep.command_V);
    ASSERT_FALSE(tuning);
    EXPECT_EQ(tuning.error().reason, Reason::not_identifiable);
}

}  // namespace
}  // namespace fidservo::calib
