// SPDX-License-Identifier: GPL-3.0-or-later
// Each departure against an answer worked out by hand.
#include "tests/reference/departed_rig.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

namespace fidservo::reference {
namespace {

using testing::after;
using testing::from_rest;
using testing::gain;
using testing::rig;

double tau_s() {
    return -rig().tick_s / std::log(rig().macro.velocity_pole);
}

TEST(DriveGain, SteadySpeed_FollowsTheDeadZoneOfTheGainedVoltage) {
    Departures departures;
    departures.drive.gain = 0.9;
    const double speed = gain() * (0.364 + 0.636 * (0.9 * 4.0 - 3.0));
    EXPECT_NEAR(from_rest(departures, 500, 4.0).carriage.speed_mm_per_s, speed, 1e-6);
}

TEST(DriveDelay, Motion_IsThatOfTheNominalCarriageLater) {
    const RigModel nominal = make_rig_model(rig());
    Departures departures;
    departures.drive.delay_s = 2.4e-3;
    const RigModel late = make_rig_model(rig(), departures);
    const State reference = after(nominal, start(nominal, 30.0, 1), 97, 4.0);
    const State delayed = after(late, start(late, 30.0, 1), 100, 4.0);
    // 97.6 ms of motion; from 97.0 ms on by the exact solution
    const double end_speed = gain() * (0.364 + 0.636);
    const double decay = std::exp(-0.6e-3 / tau_s());
    const double v = reference.carriage.speed_mm_per_s;
    EXPECT_NEAR(delayed.carriage.speed_mm_per_s, end_speed + (v - end_speed) * decay, 1e-9);
}

TEST(Coulomb, CoastingCarriage_StopsAfterTheTimeAndWayOfTheClosedForm) {
    Departures departures;
    departures.friction.coulomb_V = 0.2;
    const RigModel model = make_rig_model(rig(), departures);
    State state = start(model, 30.0, 1);
    state.carriage.speed_mm_per_s = 100.0;
    // m dv/dt = -F - b v: v = (v0 + K F) exp(-t / tau) - K F
    const double held = gain() * 0.2;
    const double stop_s = tau_s() * std::log((100.0 + held) / held);
    const double way_mm = tau_s() * 100.0 - held * stop_s;
    const State moving = after(model, state, static_cast<int>(stop_s / 1e-3), 0.0);
    EXPECT_GT(moving.carriage.speed_mm_per_s, 0.0);
    const State stopped = after(model, moving, 1, 0.0);
    EXPECT_EQ(stopped.carriage.speed_mm_per_s, 0.0);
    EXPECT_NEAR(stopped.carriage.position_mm - 30.0, way_mm, 1e-8);
}

TEST(Coulomb, AtRest_HoldsUpToItsLevel) {
    Departures departures;
    departures.friction.coulomb_V = 0.4;  // the dead zone passes 0.364 V at 3 V, 0.4 V at 3.0566 V
    EXPECT_EQ(from_rest(departures, 100, 3.05).carriage.speed_mm_per_s, 0.0);
    EXPECT_GT(from_rest(departures, 100, 3.06).carriage.speed_mm_per_s, 0.0);
}

TEST(DeadZoneOnMotion, DrivenCarriage_MovesAsBeforeAndBrakesWhileItCoasts) {
    Departures departures;
    departures.friction.dead_zone_on_motion = 1.0;
    const State nominal = from_rest({}, 150, 4.0), braked = from_rest(departures, 150, 4.0);
    EXPECT_NEAR(braked.carriage.position_mm, nominal.carriage.position_mm, 1e-9);
    EXPECT_EQ(from_rest(departures, 100, 2.99).carriage.speed_mm_per_s, 0.0);
    EXPECT_GT(from_rest(departures, 100, 3.01).carriage.speed_mm_per_s, 0.0);
    const double nominal_speed = after(make_rig_model(rig()), nominal, 20, 0.0).carriage.speed_mm_per_s;
    EXPECT_GT(nominal_speed, 50.0);
    EXPECT_EQ(after(make_rig_model(rig(), departures), braked, 20, 0.0).carriage.speed_mm_per_s, 0.0);
}

TEST(Stribeck, SteadySpeed_BalancesDriveAndFriction) {
    for (const bool elastic : {false, true}) {
        Departures departures;
        departures.friction.coulomb_V = 0.05;
        departures.friction.stribeck_V = 0.2;
        departures.friction.stribeck_speed_mm_per_s = 40.0;
        if (elastic) departures.friction.bristles = Bristles{};
        const double v = from_rest(departures, 500, 3.0).carriage.speed_mm_per_s;
        ASSERT_GT(v, 10.0);
        EXPECT_NEAR(0.364 - 0.05 - 0.2 * std::exp(-std::pow(v / 40.0, 2)) - v / gain(), 0.0, 1e-6) << elastic;
    }
}

TEST(Bristles, BelowBreakaway_YieldElasticallyAndSpringBack) {
    Departures departures;
    departures.friction.coulomb_V = 2.0;
    departures.friction.bristles = Bristles{50.0, 0.1};
    const RigModel model = make_rig_model(rig(), departures);
    const State pushed = after(model, start(model, 30.0, 1), 2000, 3.0);
    const State released = after(model, pushed, 2000, 0.0);
    EXPECT_NEAR(pushed.carriage.bristle_mm, 0.364 / 50.0, 1e-6);
    EXPECT_GT(pushed.carriage.position_mm, 30.0 + 0.364 / 50.0);  // part of the way is lost in slip
    EXPECT_NEAR(released.carriage.bristle_mm, 0.0, 1e-6);
    EXPECT_LT(released.carriage.position_mm, pushed.carriage.position_mm);
}

TEST(Bristles, StifferContact_TendsToTheRigidOne) {
    Departures rigid;
    rigid.friction.coulomb_V = 0.1;
    rigid.friction.stribeck_V = 0.2;
    const auto stop_mm = [&](std::optional<Bristles> bristles) {
        Departures departures = rigid;
        departures.friction.bristles = bristles;
        const RigModel model = make_rig_model(rig(), departures);
        return after(model, after(model, start(model, 30.0, 1), 100, 4.0), 400, 0.0).carriage.position_mm;
    };
    const double limit = stop_mm(std::nullopt);
    // measured: the difference falls with the root of the stiffness; 64 times as stiff, to an 8th
    const double soft = std::abs(stop_mm(Bristles{50.0, 0.0}) - limit);
    const double stiff = std::abs(stop_mm(Bristles{3200.0, 0.0}) - limit);
    EXPECT_LT(soft, 0.1);
    EXPECT_LT(stiff, 0.2 * soft);
}

TEST(RailPatch, CoastingThroughIt_LosesItsWork) {
    Departures departures;
    departures.friction.patch_V = 0.02;
    departures.friction.patch_centre_mm = 31.0;
    departures.friction.patch_width_mm = 0.1;
    const RigModel model = make_rig_model(rig(), departures);
    State state = start(model, 30.0, 1);
    state.carriage.speed_mm_per_s = 150.0;
    const State passed = after(model, state, 20, 0.0);
    ASSERT_GT(passed.carriage.position_mm, 31.5);
    // coasting keeps v + y / tau; the patch takes the integral of F / (m v) dy from it
    const double lost =
        150.0 - passed.carriage.speed_mm_per_s - (passed.carriage.position_mm - 30.0) / tau_s();
    const double work_V_mm = 0.02 * 0.1 * std::sqrt(2.0 * std::numbers::pi);
    const double speed_there = 150.0 - 1.0 / tau_s();
    EXPECT_NEAR(lost, work_V_mm * gain() / tau_s() / speed_there, 0.02 * lost);
}

TEST(Viscous, Asymmetry_DividesTheSteadySpeedOfItsDirectionOnly) {
    Departures departures;
    departures.friction.viscous_backward = 1.25;
    const double right = from_rest(departures, 400, 3.0).carriage.speed_mm_per_s;
    const double left = from_rest(departures, 400, -3.0).carriage.speed_mm_per_s;
    EXPECT_NEAR(right, 0.364 * gain(), 1e-5);
    EXPECT_NEAR(left, -0.364 * gain() / 1.25, 1e-5);
}

TEST(Payload, TimeConstant_GrowsAndTheGainStays) {
    Departures departures;
    departures.mechanics.payload = 1.5;
    const double v = from_rest(departures, 50, 3.0).carriage.speed_mm_per_s;
    EXPECT_NEAR(v, 0.364 * gain() * (1.0 - std::exp(-0.05 / (1.5 * tau_s()))), 1e-6);
}

TEST(Cable, SpringAtRest_IsHeldByTheDeadZone) {
    Departures departures;
    departures.mechanics.cable_V_per_mm = 0.04;
    departures.mechanics.cable_centre_mm = 100.0;  // 2.8 V at 30 mm
    EXPECT_EQ(from_rest(departures, 100, 0.0).carriage.position_mm, 30.0);
    EXPECT_GT(from_rest(departures, 100, 0.3).carriage.position_mm, 30.0);
}

TEST(Cogging, DrivingForce_IsPeriodicInPlace) {
    Departures departures;
    departures.mechanics.cogging_V = 0.5;
    departures.mechanics.cogging_period_mm = 2.0;
    const CarriageModel model = make_carriage(rig(), departures);
    EXPECT_NEAR(driving_force_V(model, 4.0, 10.5), 0.364 + 0.636 * 1.5, 1e-12);
    EXPECT_NEAR(driving_force_V(model, 4.0, 11.5), 0.364 + 0.636 * 0.5, 1e-12);
    EXPECT_NEAR(driving_force_V(model, 4.0, 12.5), driving_force_V(model, 4.0, 10.5), 1e-12);
}

TEST(Fading, SteadySpeed_IsThatOfTheLowerVoltage) {
    Departures departures;
    departures.drive.fading_per_s = 0.1;
    const RigModel model = make_rig_model(rig(), departures);
    State state = start(model, 30.0, 1);
    state.tick = 500;  // 5 % have been lost; 1 % more in a tenth of a second
    const double speed = gain() * (0.364 + 0.636 * (0.95 * 4.0 - 3.0));
    const double later = gain() * (0.364 + 0.636 * (0.94 * 4.0 - 3.0));
    const double v = after(model, state, 100, 4.0).carriage.speed_mm_per_s;
    EXPECT_GT(v, later * (1.0 - std::exp(-0.1 / tau_s())));
    EXPECT_LT(v, speed);
}

TEST(Drag, SteadySpeed_BalancesTheSquare) {
    Departures departures;
    departures.friction.drag_V_s2_per_mm2 = 1e-5;
    const double v = from_rest(departures, 500, 4.0).carriage.speed_mm_per_s;
    EXPECT_NEAR(v / gain() + 1e-5 * v * v, 1.0, 1e-9);
    EXPECT_NEAR(from_rest(departures, 100, -4.0).carriage.speed_mm_per_s,
                -from_rest(departures, 100, 4.0).carriage.speed_mm_per_s, 1e-9);
}

TEST(Play, Reversal_LeavesTheCarriageUntilThePlayIsCrossed) {
    Departures departures;
    departures.mechanics.play_mm = 0.4;
    const RigModel model = make_rig_model(rig(), departures), stiff = make_rig_model(rig());
    const State right = after(model, start(model, 30.0, 1), 60, 4.0);
    const State driven = after(stiff, start(stiff, 30.0, 1), 60, 4.0);
    EXPECT_NEAR(right.carriage.position_mm, driven.carriage.position_mm - 0.2, 1e-12);
    State back = after(model, after(model, right, 300, 0.0), 1, -4.0);
    const double rest_mm = back.carriage.position_mm;
    while (back.carriage.ahead_mm > -0.2 + 1e-12) {
        ASSERT_EQ(back.carriage.position_mm, rest_mm);
        advance(model, back, -4.0, 0.0);
    }
    EXPECT_LE(back.carriage.position_mm, rest_mm);
}

TEST(Stretch, FreeMasses_SwingAtTheirNaturalFrequencyWithTheirDamping) {
    Departures departures;
    departures.mechanics.stretch = {.compliance_mm_per_V = 0.1, .damping_ratio = 0.02, .motor_share = 0.3};
    Rig undamped = rig();
    const double inertia = tau_s() / gain();
    undamped.macro.velocity_gain_mm_per_s_per_V *= 1e6;  // no damping by the motor; the same inertia
    undamped.macro.velocity_pole = std::exp(-undamped.tick_s / (tau_s() * 1e6));
    const RigModel model = make_rig_model(undamped, departures);
    State state = start(model, 100.0, 1);
    state.carriage.stretch_mm = 1.0;
    const double omega = std::sqrt(1.0 / (0.1 * 0.3 * 0.7 * inertia));
    const double damped = omega * std::sqrt(1.0 - 0.02 * 0.02);
    for (int k = 1; k <= 100; ++k) {
        advance(model, state, 0.0, 0.0);
        const double t_s = k * 1e-3;
        const double z_mm = std::exp(-0.02 * omega * t_s) *
                            (std::cos(damped * t_s) + 0.02 * omega / damped * std::sin(damped * t_s));
        ASSERT_NEAR(state.carriage.stretch_mm, z_mm, 1e-3) << k;
    }
    // the carriage has 0.7 of the mass: the centre of mass stays
    EXPECT_NEAR(0.3 * state.carriage.motor_mm_per_s + 0.7 * state.carriage.speed_mm_per_s, 0.0, 1e-3);
}

TEST(Stretch, SteadySpeed_IsThatOfTheStiffAxis) {
    Departures departures;
    departures.mechanics.stretch = Stretch{};
    EXPECT_NEAR(from_rest(departures, 500, 4.0).carriage.speed_mm_per_s, gain(), 1e-6);
}

TEST(Flexure, SuddenSpeedOfTheCarriage_RingsAtItsResonance) {
    Departures departures;
    departures.flexure = {.coupling = 0.5, .frequency_hz = 20.0, .damping_ratio = 0.02};
    const RigModel model = make_rig_model(rig(), departures);
    State state = start(model, 0.0, 1);
    state.carriage.speed_mm_per_s = -100.0;
    state.carriage.swing_mm_per_s = -50.0;  // platform and carriage move together, w = coupling v
    advance(model, state, 0.0, 0.0);        // and the carriage hits the end stop at once
    ASSERT_EQ(state.carriage.speed_mm_per_s, 0.0);
    const double omega = 2.0 * std::numbers::pi * 20.0, zeta = 0.02;
    const double damped = omega * std::sqrt(1.0 - zeta * zeta);
    for (int k = 1; k < 200; ++k) {
        const double t_s = k * 1e-3;
        const double swing_mm = -50.0 / damped * std::exp(-zeta * omega * t_s) * std::sin(damped * t_s);
        ASSERT_NEAR(state.carriage.swing_mm, swing_mm, 1e-6) << k;
        advance(model, state, 0.0, 0.0);
    }
}

TEST(Heater, Departures_EnterTheFirstOrderStepAsTheyShould) {
    Departures departures;
    departures.heater.ambient_degC = 3.0;
    departures.heater.gain = 1.1;
    departures.heater.heating_tau = 1.2;
    departures.heater.cooling_tau = 0.7;
    departures.heater.delay_s = 5e-3;
    const RigModel model = make_rig_model(rig(), departures);
    const State hot = after(model, start(model, 30.0, 1), 1005, 0.0, 1.6);
    const double rise = 1.1 * 272.0 * 0.3;
    const double hot_degC = 25.0 + rise * (1.0 - std::exp(-1.0 / (1.2 * 0.55)));
    EXPECT_NEAR(truth(model, hot).wire_degC, hot_degC, 1e-9);
    const State late = after(model, hot, 5, 0.0, 0.0);
    const double last_degC = 25.0 + rise + (hot_degC - 25.0 - rise) * std::exp(-5e-3 / (1.2 * 0.55));
    EXPECT_NEAR(truth(model, late).wire_degC, last_degC, 1e-9);
    EXPECT_NEAR(truth(model, after(model, late, 700, 0.0, 0.0)).wire_degC,
                25.0 + (last_degC - 25.0) * std::exp(-1.0), 1e-9);
}

TEST(Heater, Curvature_KeepsThePowerInTheMiddleAndTiltsTheRest) {
    WireModel wire = make_wire(rig().micro->heater, {.curvature = 0.1});
    const auto settled = [&](double volts) {
        WireState state = cold_wire(wire);
        for (int k = 0; k < 20'000; ++k) advance(wire, state, volts, 1e-3);
        return state[0];
    };
    EXPECT_NEAR(settled(1.6), 22.0 + 272.0 * 0.3, 1e-6);
    EXPECT_NEAR(settled(1.9), 22.0 + 272.0 * 0.6 * 1.1, 1e-6);
    EXPECT_NEAR(settled(1.45), 22.0 + 272.0 * 0.15 * 0.95, 1e-6);
}

TEST(Mount, IsolatedRod_TakesUpTheWiresHeatAndSlowsTheCoolingLater) {
    WireModel wire{.onset_V = 1.3,
                   .limit_V = 1.9,
                   .rise_degC_per_V = 272.0,
                   .heating_tau_s = 1e9,
                   .cooling_tau_s = 1e9,
                   .ambient_degC = 22.0,
                   .mount = {}};
    wire.mount = {.conductance_per_s = 2.0, .capacity_ratio = 3.0, .diffusion_s = 1.0, .loss_s = 1e9};
    WireState state = cold_wire(wire);
    state[0] = 102.0;
    for (int k = 0; k < 20'000; ++k) advance(wire, state, 0.0, 1e-3);
    for (const double temp_degC : state) EXPECT_NEAR(temp_degC, 22.0 + 80.0 / 4.0, 1e-4);

    Departures departures;
    departures.heater.mount.conductance_per_s = 0.15;
    const RigModel model = make_rig_model(rig(), departures), plain = make_rig_model(rig());
    const State warm = after(model, after(model, start(model, 30.0, 1), 8000, 0.0, 1.7), 5000, 0.0, 0.0);
    const State plain_warm =
        after(plain, after(plain, start(plain, 30.0, 1), 8000, 0.0, 1.7), 5000, 0.0, 0.0);
    EXPECT_GT(truth(model, warm).wire_degC, truth(plain, plain_warm).wire_degC + 1.0);
}

TEST(Hysteresis, StrokeAndStressShift_ScaleAndMoveTheTable) {
    const auto fod = rig().micro->fod;
    const HysteresisModel model = make_hysteresis(*fod, {.stress_shift_degC = 4.0, .stroke = 0.9});
    HysteresisState state = heated_to(model, 22.0);
    move_to(model, state, 90.0);
    EXPECT_NEAR(contraction_mm(model, state), 0.9 * fod->contraction_mm(86.0, 86.0), 1e-12);
    move_to(model, state, 60.0);
    EXPECT_NEAR(contraction_mm(model, state), 0.9 * fod->contraction_mm(86.0, 56.0), 1e-12);
}

TEST(Duhem, FromSaturation_RunsAlongTheMajorLoopAndInsideItStaysWithin) {
    const auto fod = rig().micro->fod;
    const HysteresisModel model = make_hysteresis(*fod, {.law = HysteresisLaw::duhem});
    HysteresisState state = heated_to(model, 10.0);
    for (double temp = 10.0; temp <= 120.0; temp += 0.5) {
        move_to(model, state, temp);
        ASSERT_NEAR(contraction_mm(model, state), fod->contraction_mm(temp, temp), 1e-9) << temp;
    }
    for (double temp = 120.0; temp >= 10.0; temp -= 0.5) {
        move_to(model, state, temp);
        ASSERT_NEAR(contraction_mm(model, state), fod->contraction_mm(120.0, temp), 1e-9) << temp;
    }
    NoiseStream draw(3, "path");
    double temp = 60.0;
    for (int k = 0; k < 5000; ++k) {
        temp = std::clamp(temp + 5.0 * draw.normal(), 10.0, 120.0);
        move_to(model, state, temp);
        ASSERT_GE(contraction_mm(model, state), fod->contraction_mm(temp, temp) - 1e-9) << k;
        ASSERT_LE(contraction_mm(model, state), fod->contraction_mm(120.0, temp) + 1e-9) << k;
    }
}

TEST(Encoder, ScaleAndRipple_EnterTheCount) {
    EXPECT_EQ(encoder_count(0.05, {}, 10.024), 200);
    EXPECT_EQ(encoder_count(0.05, {}, 10.025), 201);
    EXPECT_EQ(encoder_count(0.05, {.scale = 1.01}, 100.0), 2020);
    EXPECT_EQ(encoder_count(0.05, {.bow_per_mm = 1e-4, .bow_centre_mm = 50.0}, 100.0), 2005);
    EXPECT_EQ(encoder_count(0.05, {.ripple_mm = 0.1, .ripple_period_mm = 2.0}, 10.5), 212);
}

TEST(Hall, Departures_AddUpInTheVoltage) {
    const HallParameters hall = rig().micro->hall;
    const HallDepartures departures{
        .gain = 1.1, .offset_V = 0.01, .cubic = 0.08, .drift_V_per_s = 1e-3, .crosstalk_V_per_V = 2e-3};
    // s = 0.5: 1.25 (1.2 * 0.5 - 0.2 * 0.125) = 0.71875 V
    EXPECT_NEAR(hall_volts(hall, departures, {3.0, 4.0, 10.0}), 2.5 + 1.1 * 0.71875 + 0.01 + 0.01 + 0.008,
                1e-12);
    EXPECT_NEAR(hall_volts(hall, {}, {4.0, 5.0, 9.0}), 3.75, 1e-12);
    EXPECT_NEAR(hall_volts(hall, {.warm_V_per_degC = 1e-4}, {4.0, 5.0, 9.0, 50.0}), 3.755, 1e-12);
}

}  // namespace
}  // namespace fidservo::reference
