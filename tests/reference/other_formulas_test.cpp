// SPDX-License-Identifier: GPL-3.0-or-later
// Departures of which the catalogue has another formula, and smooth ones, each against an answer worked out
// by hand.
#include "tests/reference/departed_rig.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace fidservo::reference {
namespace {

using testing::from_rest;
using testing::gain;
using testing::rig;

TEST(MotorConstant, SteadySpeed_IsThatOfTheForceBehindTheDeadZone) {
    Departures departures;
    departures.drive.motor = 0.9;
    const double speed = gain() * 0.9 * (0.364 + 0.636 * 1.0);
    EXPECT_NEAR(from_rest(departures, 500, 4.0).carriage.speed_mm_per_s, speed, 1e-6);
}

TEST(ViscousPower, SteadySpeed_BalancesTheForce) {
    Departures departures;
    departures.friction.viscous_power = 0.3;
    departures.friction.viscous_exponent = 1.25;
    const double v = from_rest(departures, 500, 4.0).carriage.speed_mm_per_s;
    EXPECT_NEAR(v + 0.3 * 100.0 * std::pow(v / 100.0, 1.25), gain() * (0.364 + 0.636), 1e-6);
}

TEST(StribeckRational, SteadySpeed_BalancesTheForce) {
    Departures departures;
    departures.friction.stribeck_V = 0.2;
    departures.friction.stribeck_speed_mm_per_s = 50.0;
    departures.friction.stribeck_is_rational = true;
    const double v = from_rest(departures, 500, 4.0).carriage.speed_mm_per_s;
    EXPECT_NEAR(v / gain() + 0.2 / (1.0 + v * v / 2500.0), 0.364 + 0.636, 1e-9);
}

TEST(CableSlack, Force_BeginsWhereTheHarnessIsTaut) {
    Departures departures;
    departures.mechanics.cable_V_per_mm = 0.01;
    departures.mechanics.cable_slack_mm = 10.0;
    const CarriageModel model = make_carriage(rig(), departures);
    const auto pull_V = [&](double position_mm) {
        return driving_force_V(model, 4.0, position_mm) - (0.364 + 0.636);
    };
    EXPECT_NEAR(pull_V(109.0), 0.0, 1e-12);
    EXPECT_NEAR(pull_V(115.0), -0.636 * 0.05, 1e-12);
    EXPECT_NEAR(pull_V(80.0), 0.636 * 0.1, 1e-12);
}

TEST(SkewedCogging, Force_IsTheSineOfASkewedAngle) {
    Departures departures;
    departures.mechanics.cogging_V = 0.1;
    departures.mechanics.cogging_period_mm = 8.0;
    departures.mechanics.cogging_skew = 0.5;
    const double angle = 0.25 * std::numbers::pi;
    EXPECT_NEAR(driving_force_V(make_carriage(rig(), departures), 4.0, 81.0) - (0.364 + 0.636),
                0.636 * 0.1 * std::sin(angle + 0.5 * std::sin(angle)), 1e-12);
}

TEST(SmoothForce, ByPlaceAndBySpeed_AddsToTheBalance) {
    Departures departures;
    std::array<double, smooth_waves> wave_numbers{}, phases_rad{};
    wave_numbers.fill(4.0);
    phases_rad.fill(1.0);
    departures.discrepancy = {ActsOn::carriage_force, DependsOn::carriage_place,
                              smooth_function(0.1, 0.0, 200.0, wave_numbers, phases_rad)};
    EXPECT_NEAR(driving_force_V(make_carriage(rig(), departures), 4.0, 70.0) - (0.364 + 0.636),
                0.636 * departures.discrepancy.function(70.0), 1e-12);
    departures.discrepancy.acts_on = ActsOn::carriage_friction;
    departures.discrepancy.depends_on = DependsOn::carriage_speed;
    const double v = from_rest(departures, 500, 4.0).carriage.speed_mm_per_s;
    EXPECT_NEAR(v / gain() + departures.discrepancy.function(v), 0.364 + 0.636, 1e-6);
    EXPECT_EQ(from_rest(departures, 500, 0.0).carriage.position_mm, 30.0);
    departures.discrepancy.depends_on = DependsOn::carriage_place;
    departures.discrepancy.function = smooth_function(0.1, 0.0, 4e4, wave_numbers, phases_rad);
    const CarriageState there = from_rest(departures, 500, 4.0).carriage;
    EXPECT_NEAR(there.speed_mm_per_s / gain() + departures.discrepancy.function(there.position_mm),
                0.364 + 0.636, 1e-3);
}

TEST(WireByOtherFormulas, Rates_AreThoseOfTheirEquations) {
    const HeaterParameters heater = rig().micro->heater;
    const auto rate = [&](const HeaterDepartures& departures, double above_degC, double command_V) {
        const WireModel wire = make_wire(heater, departures);
        WireState state = cold_wire(wire);
        state[0] += above_degC;
        const double before = state[0];
        constexpr double short_s = 1e-7;
        advance(wire, state, command_V, short_s);
        return (state[0] - before) / short_s;
    };
    HeaterDepartures convection, cold;
    convection.convection = 0.4;
    EXPECT_NEAR(rate(convection, 60.0, 0.0), -60.0 * 1.4 / heater.cooling_tau_s, 1e-3);
    EXPECT_NEAR(rate(convection, 3.75, 0.0), -3.75 * 1.2 / heater.cooling_tau_s, 1e-3);
    cold.cold_gain = 0.1;
    const double rise_degC = heater.gain_degC_per_V * 0.5;
    EXPECT_NEAR(rate(cold, 0.0, heater.onset_V + 0.5), 1.1 * rise_degC / heater.heating_tau_s, 1e-3);
    EXPECT_NEAR(rate(cold, 100.0, heater.onset_V + 0.5), (1.05 * rise_degC - 100.0) / heater.heating_tau_s,
                1e-3);
}

TEST(HallByOtherFormulas, Volts_AreThoseOfTheirEquations) {
    const HallParameters hall = rig().micro->hall;
    const auto added_V = [&](const HallDepartures& departures, double place_mm, double time_s) {
        const HallInput input{place_mm, 0.0, time_s};
        return hall_volts(hall, departures, input) - hall_volts(hall, {}, input);
    };
    HallDepartures fifth, slowing;
    fifth.fifth = 0.1;
    EXPECT_NEAR(added_V(fifth, hall.centre_mm + 0.5 * hall.half_range_mm, 0.0),
                0.1 * hall.span_V * (0.5 - 1.0 / 32.0), 1e-12);
    EXPECT_NEAR(added_V(fifth, hall.centre_mm + hall.half_range_mm, 0.0), 0.0, 1e-12);
    slowing.drift_V_per_s = 2e-3;
    slowing.drift_slowing_s = 10.0;
    EXPECT_NEAR(added_V(slowing, hall.centre_mm, 10.0), 2e-2 * std::log(2.0), 1e-12);
}

TEST(WireLoadedByASpring, Shift_GrowsWithContraction) {
    const Rig plain_rig = rig();
    const FodTable& table = *plain_rig.micro->fod;
    HysteresisDepartures spring, fading;
    spring.stress_shift_degC_per_mm = 2.0;
    const HysteresisModel nominal = make_hysteresis(table, {}), loaded = make_hysteresis(table, spring);
    HysteresisState state = heated_to(loaded, 22.0), plain = heated_to(nominal, 22.0);
    constexpr int steps = 40'000;
    for (int k = 1; k <= steps; ++k) move_to(loaded, state, 22.0 + 58.0 * k / steps);
    const double x_mm = contraction_mm(loaded, state);
    EXPECT_GT(x_mm, 0.2);
    move_to(nominal, plain, 80.0 - 2.0 * x_mm);
    EXPECT_NEAR(contraction_mm(nominal, plain), x_mm, 1e-3);
    fading.stroke = 1.1;
    fading.stroke_fading_per_mm = 0.125;
    EXPECT_NEAR(contraction_mm(make_hysteresis(table, fading), plain),
                x_mm * (1.0 + 0.1 * (1.0 - 0.125 * x_mm)), 2e-3);
}

TEST(LensDivision, Corner_IsSeenAtTheQuotient) {
    const Rig plain = rig();
    CameraModel model{*plain.camera, *plain.fiducials, {}};
    const Eigen::Vector2d centre = plain.camera->geometry.principal_point_px, plate(3.0, 2.0);
    const Eigen::Vector2d straight = image_of(model, plate, 1.0) - centre;
    model.departures.division = 0.5;
    const double square = (straight / plain.camera->geometry.focal_px).squaredNorm();
    EXPECT_NEAR((image_of(model, plate, 1.0) - centre - straight / (1.0 - 0.5 * square)).norm(), 0.0, 1e-9);
}

}  // namespace
}  // namespace fidservo::reference
