// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/plant/effects/effect_rig.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

StageState after(const StagePlant& plant, double micro_V, int ticks) {
    StageState state = start(plant, 50.0, 1);
    for (int k = 0; k < ticks; ++k) advance(plant, state, 0.0, micro_V);
    return state;
}

TEST(AmbientTemperature, WarmerRoom_ShiftsTheWireByAsMuch) {
    const StagePlant plant = plant_with("ambient_temperature:shift_degC=8");
    EXPECT_DOUBLE_EQ(after(plant, 0.0, 1000).micro->heater.temp_degC, 30.0);
    EXPECT_NEAR(after(plant, 1.5, 30000).micro->heater.temp_degC, 30.0 + 272.0 * 0.2, 1e-9);
}

TEST(Airflow, Cooling_HasAnotherTimeConstantAndHeatingHasNot) {
    const StagePlant plant = plant_with("airflow:factor=0.7");
    const StageState hot = after(plant, 1.7, 550);
    EXPECT_NEAR(hot.micro->heater.temp_degC, 22.0 + 272.0 * 0.4 * (1.0 - std::exp(-1.0)), 1e-9);
    StageState state = hot;
    for (int k = 0; k < 700; ++k) advance(plant, state, 0.0, 0.0);
    EXPECT_NEAR(state.micro->heater.temp_degC - 22.0, (hot.micro->heater.temp_degC - 22.0) * std::exp(-1.0),
                1e-9);
}

TEST(HeaterGain, MorePower_HeatsMore) {
    const StagePlant plant = plant_with("heater_gain:factor=1.05");
    EXPECT_NEAR(after(plant, 1.5, 30000).micro->heater.temp_degC, 22.0 + 1.05 * 272.0 * 0.2, 1e-9);
}

TEST(StrokeChange, Contraction_IsScaledEverywhere) {
    const StagePlant plant = plant_with("stroke_change:factor=0.95");
    const StagePlant nominal = make_stage_plant(reference_rig());
    for (const int ticks : {100, 200, 300, 5000})
        EXPECT_DOUBLE_EQ(after(plant, 1.8, ticks).micro->position_mm,
                         0.95 * after(nominal, 1.8, ticks).micro->position_mm);
}

TEST(HallGain, Voltage_IsSteeperAboutItsMiddle) {
    const StagePlant plant = plant_with("hall_gain:factor=1.02");
    const StagePlant nominal = make_stage_plant(reference_rig());
    for (const double x_mm : {0.0, 1.3, 2.0, 4.0})
        EXPECT_NEAR(mean_reading_lsb(plant.micro->hall, x_mm) - 2048.0,
                    1.02 * (mean_reading_lsb(nominal.micro->hall, x_mm) - 2048.0), 1e-9);
}

TEST(HallOffset, Voltage_IsShifted) {
    const StagePlant plant = plant_with("hall_offset:offset_V=0.05");
    const StagePlant nominal = make_stage_plant(reference_rig());
    for (const double x_mm : {0.0, 1.3, 4.0})
        EXPECT_NEAR(mean_reading_lsb(plant.micro->hall, x_mm),
                    mean_reading_lsb(nominal.micro->hall, x_mm) + 0.05 * 4096.0 / 5.0, 1e-9);
}

TEST(HallOffset, MagnetAside_ReadsAsThePlatformFartherOn) {
    const StagePlant plant = plant_with("hall_offset:offset_V=0,shift_um=80");
    const StagePlant nominal = make_stage_plant(reference_rig());
    for (const double x_mm : {0.5, 1.3, 3.5})
        EXPECT_NEAR(mean_reading_lsb(plant.micro->hall, x_mm),
                    mean_reading_lsb(nominal.micro->hall, x_mm + 0.08), 1e-9);
}

TEST(HallNonlinearity, Curve_KeepsItsCentreAndEndsAndBendsBetween) {
    const StagePlant plant = plant_with("hall_nonlinearity:cubic_shift=0.08");
    const StagePlant nominal = make_stage_plant(reference_rig());
    for (const double x_mm : {0.0, 2.0, 4.0})
        EXPECT_DOUBLE_EQ(mean_reading_lsb(plant.micro->hall, x_mm),
                         mean_reading_lsb(nominal.micro->hall, x_mm));
    EXPECT_NEAR(mean_reading_lsb(plant.micro->hall, 3.0) - mean_reading_lsb(nominal.micro->hall, 3.0),
                1.25 * 0.5 * 0.08 * 0.75 * 4096.0 / 5.0, 1e-9);
}

}  // namespace
}  // namespace fidservo::plant
