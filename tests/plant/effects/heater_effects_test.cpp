// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/plant/effects/effect_rig.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

StageState after(const StagePlant& plant, double micro_V, int ticks) {
    StageState state = start(plant, 50.0, 1);
    for (int k = 0; k < ticks; ++k) advance(plant, state, 0.0, micro_V);
    return state;
}

double rise_degC(const StageState& state) {
    return state.micro->heater.temp_degC - 22.0;
}

TEST(HeatingLag, Heating_HasAnotherTimeConstantAndCoolingHasNot) {
    const StagePlant plant = plant_with("heating_lag:factor=1.4");
    const StageState hot = after(plant, 1.7, 770);
    EXPECT_NEAR(rise_degC(hot), 272.0 * 0.4 * (1.0 - std::exp(-1.0)), 1e-9);
    StageState state = hot;
    for (int k = 0; k < 1000; ++k) advance(plant, state, 0.0, 0.0);
    EXPECT_NEAR(rise_degC(state), rise_degC(hot) * std::exp(-1.0), 1e-9);
    EXPECT_NEAR(rise_degC(after(plant, 1.7, 40000)), 272.0 * 0.4, 1e-9) << "where it settles stays";
}

TEST(SecondThermalMass, CoolingAfterALongHold_HasTheTwoRatesOfThePair) {
    const StagePlant plant = plant_with("second_thermal_mass:conductance=0.4,mass_tau_s=15,taken=1");
    StageState state = after(plant, 1.6, 600000);
    EXPECT_NEAR(rise_degC(state), 272.0 * 0.3, 1e-6) << "a mass that loses heat to the wire only costs none";
    EXPECT_NEAR(state.micro->heater.mass_rise_degC[0], 272.0 * 0.3, 1e-6);
    const double sum = 1.4 + 1.0 / 15.0, product = 1.0 / 15.0;
    const double fast = 0.5 * (sum + std::sqrt(sum * sum - 4.0 * product)), slow = product / fast;
    const double start_degC = 272.0 * 0.3, slope = -start_degC;  // both start at the same temperature
    const double P = -(slope + slow * start_degC) / (fast - slow), Q = start_degC - P;
    for (int k = 1; k <= 60000; ++k) {
        advance(plant, state, 0.0, 0.0);
        if (k % 4000 != 0) continue;
        const double t = 0.001 * k;
        EXPECT_NEAR(rise_degC(state), P * std::exp(-fast * t) + Q * std::exp(-slow * t), 1e-6) << t;
    }
}

/// Against Euler's method, in steps of 1 us, for the published equations of a mount that is the wire's
/// surroundings, and of one that exchanges heat as fast as the wire heats.
TEST(SecondThermalMass, AsSurroundingsOrWithinTheWiresOwnRate_FollowsThoseEquations) {
    constexpr double share = 0.2, mass_tau_s = 5.0, heating_tau_s = 0.55, cooling_tau_s = 1.0, step_s = 1e-6;
    const auto rise_after = [&](bool surrounds) {
        double wire = 0.0, mass = 0.0;
        for (int k = 0; k < 3'000'000; ++k) {
            const double phi = k < 2'000'000 ? 272.0 * 0.3 : 0.0;
            const double around = surrounds ? share * mass : 0.0,
                         given = surrounds ? 0.0 : share * (wire - mass);
            const double tau_s = phi > wire - around ? heating_tau_s : cooling_tau_s;
            const double wire_rate = (phi - (wire - around) - given) / tau_s;
            mass += step_s / mass_tau_s * (wire - mass);
            wire += step_s * wire_rate;
        }
        return wire;
    };
    const auto plant_after = [&](const std::string& effect) {
        const StagePlant plant = plant_with("second_thermal_mass:conductance=0.2,mass_tau_s=5," + effect);
        StageState state = after(plant, 1.6, 2000);
        for (int k = 0; k < 1000; ++k) advance(plant, state, 0.0, 0.0);
        return rise_degC(state);
    };
    EXPECT_NEAR(plant_after("taken=0"), rise_after(true), 1e-3);
    EXPECT_NEAR(plant_after("heating=" + std::to_string(cooling_tau_s / heating_tau_s)), rise_after(false),
                1e-3);
}

/// Against Euler's method, in steps of 1 us, for the equations of a mount that only gives heat back.
TEST(SecondThermalMass, AsASource_FollowsThoseEquations) {
    constexpr double share = 0.19, mass_tau_s = 7.0, heating_tau_s = 0.55, cooling_tau_s = 1.0, step_s = 1e-6;
    double wire = 0.0, mass = 0.0;
    const StagePlant plant = plant_with("second_thermal_mass:conductance=0.19,mass_tau_s=7,taken=0,source=1");
    StageState state = start(plant, 50.0, 1);
    for (int tick = 0; tick < 4000; ++tick) {
        const double command_V = tick < 2500 ? 1.6 : 1.4, phi = 272.0 * (command_V - 1.3);
        advance(plant, state, 0.0, command_V);
        for (int k = 0; k < 1000; ++k) {
            const double tau_s = phi > wire ? heating_tau_s : cooling_tau_s;
            const double wire_rate = (phi - wire) / tau_s + share / cooling_tau_s * mass;
            mass += step_s / mass_tau_s * (wire - mass);
            wire += step_s * wire_rate;
        }
        ASSERT_NEAR(rise_degC(state), wire, 2e-3) << "tick " << tick;
    }
}

/// At equilibrium, the heat that the wire receives is lost directly and through the mass, by conductances in
/// series.
TEST(SecondThermalMass, ThatLosesHeatToTheRoom_SettlesByConductancesInSeries) {
    constexpr double conductance = 0.4, to_room = 0.6;
    const StagePlant plant = plant_with("second_thermal_mass:conductance=0.4,mass_tau_s=3,taken=2.5");
    const double through_mass = conductance * to_room / (conductance + to_room);
    EXPECT_NEAR(rise_degC(after(plant, 1.6, 100000)), 272.0 * 0.3 / (1.0 + 0.55 * through_mass), 1e-6);
}

TEST(SecondThermalMass, ColdMass_DrawsHeatAtFirst) {
    const StagePlant nominal = make_stage_plant(reference_rig());
    const StagePlant plant = plant_with("second_thermal_mass:conductance=0.4");
    EXPECT_LT(rise_degC(after(plant, 1.6, 1000)), rise_degC(after(nominal, 1.6, 1000)) - 5.0);
}

TEST(SecondThermalMass, ThatConducts_DrawsAsMuchAtFirstAndLessAsItsNearEndWarms) {
    const auto rise_after = [](const char* diffusion, int ticks) {
        return rise_degC(
            after(plant_with(std::string("second_thermal_mass:conductance=0.4,mass_tau_s=4,diffusion_s=") +
                             diffusion),
                  1.6, ticks));
    };
    EXPECT_NEAR(rise_after("6", 20), rise_after("0", 20), 2e-3);
    EXPECT_GT(rise_after("6", 2000), rise_after("0", 2000) + 1.0);
    EXPECT_NEAR(rise_after("6", 200000), rise_after("0", 200000), 1e-3) << "it loses no heat to the room";
}

TEST(HeaterDelay, Of3700Microseconds_IsTheNominalCourseThatMuchLater) {
    const StagePlant plant = plant_with("heater_delay:delay_ms=3.7");
    for (const int ticks : {4, 5, 100, 549}) {
        const double heated_s = 0.001 * ticks - 0.0037;
        EXPECT_NEAR(rise_degC(after(plant, 1.7, ticks)), 272.0 * 0.4 * -std::expm1(-heated_s / 0.55), 1e-10)
            << ticks;
    }
    EXPECT_EQ(rise_degC(after(plant, 1.7, 3)), 0.0);
}

TEST(HeaterDelay, WholeTicks_AreTheNominalCourseOfEarlierTicks) {
    const StagePlant nominal = make_stage_plant(reference_rig());
    const StagePlant plant = plant_with("heater_delay:delay_ms=20");
    EXPECT_NEAR(rise_degC(after(plant, 1.8, 320)), rise_degC(after(nominal, 1.8, 300)), 1e-9);
}

TEST(HeaterDelay, WithASecondMass_DelaysTheWholePair) {
    const StagePlant pair = plant_with("second_thermal_mass");
    const std::vector<EffectSetting> both{parse_effect("second_thermal_mass"),
                                          parse_effect("heater_delay:delay_ms=50")};
    const StagePlant late = make_stage_plant(reference_rig(), both);
    EXPECT_NEAR(rise_degC(after(late, 1.8, 1050)), rise_degC(after(pair, 1.8, 1000)), 1e-9);
}

TEST(StressShift, Transformation_HappensThatMuchLater) {
    const StagePlant nominal = make_stage_plant(reference_rig());
    const StagePlant loaded = plant_with("stress_shift:shift_degC=6");
    // A wire in a cold room under a command that heats it more by the same amount has the same place in the
    // table.
    const StagePlant warm = plant_with("ambient_temperature:shift_degC=-6");
    for (const int ticks : {200, 400, 3000}) {
        const StageState state = after(loaded, 1.8, ticks);
        EXPECT_EQ(state.micro->heater.temp_degC, after(nominal, 1.8, ticks).micro->heater.temp_degC);
        EXPECT_NEAR(state.micro->position_mm, after(warm, 1.8, ticks).micro->position_mm, 1e-9)
            << "inseparable from a room that is colder by as much";
    }
    EXPECT_LT(after(loaded, 1.55, 3000).micro->position_mm, after(nominal, 1.55, 3000).micro->position_mm);
}

/// A wire that was only ever heated is at f(T - c x, T - c x).
TEST(StressShift, OfASpring_GrowsWithContraction) {
    const StagePlant loaded = plant_with("stress_shift:shift_degC=1,spring_degC_per_mm=2.5");
    for (const int ticks : {400, 3000, 20'000}) {
        const MicroStageState state = *after(loaded, 1.6, ticks).micro;
        const double seen_degC = state.heater.temp_degC - 1.0 - 2.5 * state.position_mm;
        EXPECT_NEAR(state.position_mm, loaded.micro->fod->contraction_mm(seen_degC, seen_degC), 1e-3)
            << ticks;
    }
    EXPECT_GT(after(loaded, 1.6, 20'000).micro->position_mm, 0.5);
}

}  // namespace
}  // namespace fidservo::plant
