// SPDX-License-Identifier: GPL-3.0-or-later
// Rigs whose forces are formulas of their files, beside the same machines integrated by a program of their
// own: Newton's law in SI units, classical Runge-Kutta steps of 10 us, dry friction by whether a step would
// turn the motion round.
#include "core/rig.h"
#include "plant/stage_plant.h"
#include "src/files/rig/rig_file.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

/// A machine of one degree of freedom with a motor: m dv/dt = k (u - e v) + force(y, v) against dry friction.
struct Machine {
    double mass_kg;
    double force_per_volt_N, back_emf_V_s_per_m;
    std::function<double(double y_m, double v_m_per_s)> force_N;
    std::function<double(double u_V)> dry_N;  ///< friction's level
    double viscous_per_heat_N_s_per_m = 0.0;  ///< per V^2
    double y_m = 0.0, v_m_per_s = 0.0, heat_V2 = 0.0;

    void step(double u_V, double h_s) {
        const auto push = [&](double y, double v) {
            return force_per_volt_N * (u_V - back_emf_V_s_per_m * v) + force_N(y, v) -
                   viscous_per_heat_N_s_per_m * heat_V2 * v;
        };
        const double level_N = dry_N(u_V);
        if (v_m_per_s == 0.0 && std::abs(push(y_m, 0.0)) <= level_N) return;
        const double sign =
            v_m_per_s != 0.0 ? std::copysign(1.0, v_m_per_s) : std::copysign(1.0, push(y_m, 0.0));
        const auto rate = [&](double y, double v) {
            return std::array{v, (push(y, v) - sign * level_N) / mass_kg};
        };
        const auto a = rate(y_m, v_m_per_s);
        const auto b = rate(y_m + 0.5 * h_s * a[0], v_m_per_s + 0.5 * h_s * a[1]);
        const auto c = rate(y_m + 0.5 * h_s * b[0], v_m_per_s + 0.5 * h_s * b[1]);
        const auto d = rate(y_m + h_s * c[0], v_m_per_s + h_s * c[1]);
        const double before = v_m_per_s;
        y_m += h_s / 6.0 * (a[0] + 2.0 * b[0] + 2.0 * c[0] + d[0]);
        v_m_per_s += h_s / 6.0 * (a[1] + 2.0 * b[1] + 2.0 * c[1] + d[1]);
        if (level_N > 0.0 && before * v_m_per_s < 0.0) v_m_per_s = 0.0;
    }
};

/// Commands of several frequencies with pauses, V.
double command_V(int tick, double amplitude_V) {
    const double t = 1e-3 * tick;
    if (tick % 2000 > 1500) return 0.0;
    return amplitude_V * (0.6 * std::sin(2.0 * std::numbers::pi * 0.7 * t) +
                          0.4 * std::sin(2.0 * std::numbers::pi * 2.3 * t));
}

/// The largest distance of the two over some seconds, mm.
double farthest_mm(const char* name, Machine machine, double start_mm, double amplitude_V) {
    const Rig rig = load_rig(std::filesystem::path(FIDSERVO_ASSETS_DIR) / "rigs" / name);
    const StagePlant plant = make_stage_plant(rig);
    StageState state = start(plant, start_mm, 1);
    machine.y_m = 1e-3 * start_mm;
    double farthest = 0.0, way_mm = 0.0;
    for (int tick = 0; tick < 6000; ++tick) {
        const double u_V = command_V(tick, amplitude_V), before_mm = state.axis.position_mm;
        advance(plant, state, u_V, 0.0);
        for (int k = 0; k < 100; ++k) machine.step(u_V, 1e-5);
        machine.heat_V2 += (u_V * u_V - machine.heat_V2) * -std::expm1(-1e-3 / 30.0);
        farthest = std::max(farthest, std::abs(state.axis.position_mm - 1e3 * machine.y_m));
        way_mm += std::abs(state.axis.position_mm - before_mm);
    }
    EXPECT_GT(way_mm, 50.0) << "it moves";
    return farthest;
}

/// A motor of a rig file's gain and time constant: m = 1 kg, K = 1 / e, tau = m / (k e).
Machine motor(double gain_mm_per_s_per_V, double tau_s) {
    Machine machine{1.0, 0.0, 1e3 / gain_mm_per_s_per_V, [](double, double) { return 0.0; },
                    [](double) { return 0.0; }};
    machine.force_per_volt_N = machine.mass_kg / (tau_s * machine.back_emf_V_s_per_m);
    return machine;
}

TEST(OwnRigs, PendulumServo_MovesAsThePendulumOfMechanics) {
    Machine machine = motor(120.0, 0.08);
    // m g l in place of 2.4 V, on an arm of 0.1 m.
    const double weight_N = 2.4 * machine.force_per_volt_N;
    machine.force_N = [=](double y_m, double) { return -weight_N * std::sin(y_m / 0.1); };
    EXPECT_LT(farthest_mm("pendulum_servo.yaml", machine, 20.0, 3.0), 0.01);
}

TEST(OwnRigs, BrakedSpindle_StopsAndWarmsAsItsOwnProgramSays) {
    Machine machine = motor(40.0, 0.03);
    const double k = machine.force_per_volt_N;
    machine.dry_N = [=](double u_V) { return k * (std::abs(u_V) < 0.5 ? 3.0 : 0.15); };
    machine.viscous_per_heat_N_s_per_m = k * 2e-4 * 1e3;
    EXPECT_LT(farthest_mm("braked_spindle.yaml", machine, 200.0, 6.0), 0.01);
}

TEST(OwnRigs, LinearMotor_SwingsAboutItsMagneticSpring) {
    Machine machine = motor(150.0, 0.15);
    const double k = machine.force_per_volt_N;
    machine.force_N = [=](double y_m, double) {
        const double off_m = y_m - 0.06, a = 2.0 * std::numbers::pi * y_m / 0.012;
        return k *
               (-20.0 * off_m - 1e4 * off_m * off_m * off_m + 0.3 * (std::sin(a) + 0.25 * std::sin(2.0 * a)));
    };
    EXPECT_LT(farthest_mm("magnetic_linear_motor.yaml", machine, 70.0, 1.5), 0.01);
}

}  // namespace
}  // namespace fidservo::plant
