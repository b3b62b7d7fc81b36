// SPDX-License-Identifier: GPL-3.0-or-later
// How the integration converges as its sub-steps are halved. The classical Runge-Kutta method is of order 4:
// the error falls to a 16th, also across end stops and a carriage that sticks, as their times are located.
#include "core/rig.h"
#include "reference/reference_rig.h"
#include "src/files/rig/rig_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::reference {
namespace {

/// Ticks of 20 ms: long enough for errors well above rounding.
Rig coarse_rig() {
    Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    constexpr double longer = 20.0;
    rig.macro.velocity_pole = std::pow(rig.macro.velocity_pole, longer);
    rig.tick_s *= longer;
    return rig;
}

/// A simulated quantity under random motor and heater voltages that change at every fourth tick.
using Quantity = std::function<double(const Truth&)>;

std::vector<double> run(const Departures& departures, int substeps, const Quantity& quantity) {
    constexpr std::array motor_V{5.0, 0.0, -4.2, 0.0, 3.4, -5.0, 0.0, 4.6};
    constexpr std::array heater_V{1.9, 1.7, 1.2, 1.5, 1.9, 1.3, 1.6, 0.0};
    const RigModel model = make_rig_model(coarse_rig(), departures, substeps);
    State state = start(model, 60.0, 1);
    std::vector<double> values;
    constexpr int ticks = 200;
    values.reserve(ticks);
    for (int k = 0; k < ticks; ++k) {
        const auto piece = static_cast<std::size_t>(k / 4) % motor_V.size();
        advance(model, state, motor_V[piece], heater_V[piece]);
        values.push_back(quantity(truth(model, state)));
    }
    return values;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double worst = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
    return worst;
}

/// log2 of the ratio of the errors with n and 2 n sub-steps.
double order(const Departures& departures, int substeps, const Quantity& quantity) {
    constexpr int fine = 512;
    const std::vector<double> limit = run(departures, fine, quantity);
    const double error = largest_difference(run(departures, substeps, quantity), limit);
    const double halved = largest_difference(run(departures, 2 * substeps, quantity), limit);
    std::printf("%d sub-steps %.3e, %d sub-steps %.3e, order %.2f\n", substeps, error, 2 * substeps, halved,
                std::log2(error / halved));
    return std::log2(error / halved);
}

double carriage(const Truth& truth) {
    return truth.carriage_mm;
}
double wire(const Truth& truth) {
    return truth.wire_degC;
}

TEST(Convergence, NominalCarriage_IsOfOrderFour) {
    EXPECT_NEAR(order({}, 4, carriage), 4.0, 0.3);
}

TEST(Convergence, CoulombFriction_KeepsOrderFourAsTheCarriageSticks) {
    Departures departures;
    departures.friction.coulomb_V = 0.3;
    EXPECT_NEAR(order(departures, 4, carriage), 4.0, 0.5);
    departures.friction.viscous_backward = 1.3;
    departures.mechanics.cable_V_per_mm = 2e-3;
    EXPECT_GE(order(departures, 4, carriage), 3.5);
}

TEST(Convergence, WireAndMount_AreOfOrderFour) {
    Departures departures;
    EXPECT_NEAR(order(departures, 1, wire), 4.0, 0.3);
    departures.heater.mount.conductance_per_s = 0.3;
    EXPECT_NEAR(order(departures, 2, wire), 4.0, 0.5);
}

TEST(Convergence, SwingingPlatform_IsOfOrderFour) {
    Departures departures;
    departures.flexure.coupling = 1.0;
    departures.flexure.frequency_hz = 8.0;
    EXPECT_NEAR(order(departures, 8, [](const Truth& truth) { return truth.platform_mm; }), 4.0, 0.5);
}

}  // namespace
}  // namespace fidservo::reference
