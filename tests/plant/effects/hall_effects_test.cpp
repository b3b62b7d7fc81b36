// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/plant/effects/effect_rig.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

constexpr double lsb_per_V = 4096.0 / 5.0;

/// Mean of many readings in the same state, in LSB: the noise of 0.4 LSB leaves 0.004 of it.
double mean_reading(const StagePlant& plant, StageState& state) {
    double sum = 0.0;
    constexpr int readings = 20000;
    for (int k = 0; k < readings; ++k) sum += sample(plant, state).hall_adc;
    return sum / readings;
}
// Rounding of a reading with 0.4 LSB noise biases the mean by up to exp(-2 (0.4 pi)^2) / pi = 0.0135 LSB.
constexpr double mean_tolerance_lsb = 2 * 0.0135 + 4.5 * 0.005;

StageState after(const StagePlant& plant, double macro_V, int ticks) {
    StageState state = start(plant, 50.0, 1);
    for (int k = 0; k < ticks; ++k) advance(plant, state, macro_V, 0.0);
    return state;
}

TEST(HallDrift, Zero_RunsAwayAtItsRate) {
    const StagePlant nominal = make_stage_plant(reference_rig());
    const StagePlant plant = plant_with("hall_drift:rate_mV_per_s=2");
    for (const int ticks : {0, 10000, 40000}) {
        StageState drifted = after(plant, 0.0, ticks), still = after(nominal, 0.0, ticks);
        EXPECT_NEAR(mean_reading(plant, drifted) - mean_reading(nominal, still),
                    0.002 * 0.001 * ticks * lsb_per_V, mean_tolerance_lsb)
            << ticks;
    }
}

TEST(HallDrift, AfterLong_StopsAtItsBound) {
    const StagePlant nominal = make_stage_plant(reference_rig());
    const StagePlant plant = plant_with("hall_drift:rate_mV_per_s=20");
    StageState drifted = after(plant, 0.0, 80000), still = after(nominal, 0.0, 0);
    EXPECT_NEAR(mean_reading(plant, drifted) - mean_reading(nominal, still), 1.0 * lsb_per_V,
                mean_tolerance_lsb);
}

TEST(HallCrosstalk, Reading_MovesByTheLeakPerVoltOnTheDrive) {
    const StagePlant nominal = make_stage_plant(reference_rig());
    const StagePlant plant = plant_with("hall_crosstalk:leak_mV_per_V=8");
    for (const auto& [command_V, drive_V] : {std::pair(0.0, 0.0), {2.5, 2.5}, {-4.0, -4.0}, {9.0, 5.0}}) {
        StageState leaking = after(plant, command_V, 20), clean = after(nominal, command_V, 20);
        EXPECT_NEAR(mean_reading(plant, leaking) - mean_reading(nominal, clean), 0.008 * drive_V * lsb_per_V,
                    mean_tolerance_lsb)
            << command_V;
    }
}

TEST(HallCrosstalk, Reading_IsOfTheCommandBeforeIt) {
    const StagePlant plant = plant_with("hall_crosstalk:leak_mV_per_V=50");
    StageState state = start(plant, 50.0, 1);
    const int before = sample(plant, state).hall_adc;
    advance(plant, state, 4.0, 0.0);
    const int during = sample(plant, state).hall_adc;
    advance(plant, state, 0.0, 0.0);
    const int afterwards = sample(plant, state).hall_adc;
    EXPECT_NEAR(during - before, 0.05 * 4.0 * lsb_per_V, 4.0);
    EXPECT_NEAR(afterwards - before, 0.0, 4.0);
}

TEST(HallCrosstalk, BehindAFilter_FollowsTheDriveByItsExponential) {
    constexpr double lag_s = 0.004;
    const StagePlant plant = plant_with("hall_crosstalk:leak_mV_per_V=50,lag_ms=4");
    StageState state = start(plant, 50.0, 1);
    const double before = mean_reading(plant, state);
    for (int ticks = 1; ticks <= 20; ++ticks) {
        advance(plant, state, 4.0, 0.0);
        EXPECT_NEAR(mean_reading(plant, state) - before,
                    0.05 * 4.0 * lsb_per_V * -std::expm1(-0.001 * ticks / lag_s), mean_tolerance_lsb);
    }
}

TEST(HallDisturbances, Truth_IsUntouched) {
    const std::vector<EffectSetting> both{parse_effect("hall_drift"), parse_effect("hall_crosstalk")};
    const StagePlant nominal = make_stage_plant(reference_rig());
    const StagePlant plant = make_stage_plant(reference_rig(), both);
    EXPECT_EQ(camera_position_mm(after(plant, 4.0, 500)), camera_position_mm(after(nominal, 4.0, 500)));
}

}  // namespace
}  // namespace fidservo::plant
