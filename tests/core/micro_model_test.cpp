// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/micro_model.h"

#include "core/micro_parameters.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

constexpr HeaterParameters heater{1.3, 1.9, 272.0, 0.55, 1.0, 22.0};

TEST(HeaterModel, Step_FollowsTheRegimeItIsIn) {
    EXPECT_DOUBLE_EQ(heater_step_degC(heater, 80.0, 0.0, 1.0), 22.0 + 58.0 * std::exp(-1.0));
    EXPECT_DOUBLE_EQ(heater_step_degC(heater, 22.0, 1.5, 0.55), 22.0 + 0.2 * 272.0 * (1.0 - std::exp(-1.0)));
}

TEST(HeaterModel, CommandBelowOnsetOrAboveLimit_IsClamped) {
    EXPECT_DOUBLE_EQ(heater_rise_degC(heater, 1.2), 0.0);
    EXPECT_DOUBLE_EQ(heater_rise_degC(heater, 5.0), heater_rise_degC(heater, 1.9));
}

TEST(HeaterModel, Command_IsTheInverseOfTheRate) {
    constexpr double dt_s = 1e-6;
    for (const double rate : {-20.0, -5.0, 0.0, 5.0, 60.0}) {
        const double command_V = heater_command_V(heater, 70.0, rate);
        EXPECT_NEAR((heater_step_degC(heater, 70.0, command_V, dt_s) - 70.0) / dt_s, rate, 1e-3);
    }
}

}  // namespace
}  // namespace fidservo
