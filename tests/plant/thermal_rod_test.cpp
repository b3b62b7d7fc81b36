// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/thermal_rod.h"

#include "core/random.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

ThermalPair drawn_pair(NoiseStream& draw) {
    const double taken = 3.0 * draw.uniform();
    const double most_coupling = taken < 1.0 ? std::min(1.0, 0.8 / (1.0 - taken)) : 1.0;
    return {0.3 + draw.uniform(),
            0.3 + draw.uniform(),
            0.05 + most_coupling * draw.uniform(),
            2.0 + 10.0 * draw.uniform(),
            taken,
            1.0 + draw.uniform()};
}

/// Runge-Kutta of the fourth order on the equations as they stand, the regime chosen anew at every step.
RodRise integrate(const ThermalPair& pair, double diffusion_s, RodRise y, double phi, double time_s,
                  int steps) {
    const double s = pair.coupling * std::max(0.0, 1.0 - pair.taken), p = std::max(1.0, pair.taken);
    const double n = rod_parts, conducted = n * n / diffusion_s;
    const auto slope = [&](const RodRise& at) {
        const double lacks = phi - at(0) + s * at(1);
        const double tau_s = lacks > 0.0 ? pair.heating_tau_s : pair.cooling_tau_s;
        const double h = lacks > 0.0 ? pair.heating : 1.0;
        RodRise rate = RodRise::Zero();
        rate(0) = lacks / tau_s - h * (pair.coupling - s) / pair.cooling_tau_s * (p * at(0) - at(1));
        rate(1) = n / (p * pair.mass_tau_s) * (p * at(0) - at(1));
        for (int i = 1; i <= rod_parts; ++i) rate(i) -= at(i) * (p - 1.0) / (p * pair.mass_tau_s);
        for (int i = 1; i < rod_parts; ++i) {
            const double flow = conducted * (at(i) - at(i + 1));
            rate(i) -= flow;
            rate(i + 1) += flow;
        }
        return rate;
    };
    const double step = time_s / steps;
    for (int k = 0; k < steps; ++k) {
        const RodRise a = slope(y), b = slope(y + 0.5 * step * a), c = slope(y + 0.5 * step * b),
                      d = slope(y + step * c);
        y += step / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
    return y;
}

TEST(ThermalRod, ClosedForm_SolvesTheEquationsInBothRegimes) {
    NoiseStream draw(21, "cases");
    for (int k = 0; k < 30; ++k) {
        const ThermalPair pair = drawn_pair(draw);
        const double diffusion_s = 0.5 + 4.0 * draw.uniform(), phi = 60.0;
        const ThermalRod rod = thermal_rod(pair, diffusion_s, 1e-3);
        RodRise start;
        for (double& rise : start) rise = 40.0 + 60.0 * draw.uniform();
        const RodRise expected = integrate(pair, diffusion_s, start, phi, 2.0, 200000);
        EXPECT_NEAR((advance(rod, start, phi, 2.0) - expected).norm(), 0.0, 2e-5) << "seed 21, case " << k;
    }
}

TEST(ThermalRod, TickByTick_IsTheSameAsTheClosedForm) {
    NoiseStream draw(22, "cases");
    for (int k = 0; k < 30; ++k) {
        const ThermalRod rod = thermal_rod(drawn_pair(draw), 2.0, 0.02);
        RodRise by_ticks = RodRise::Constant(20.0), whole = by_ticks;
        for (int i = 0; i < 200; ++i) {
            const double phi = i % 40 < 20 ? 80.0 : 40.0;
            by_ticks = advance(rod, by_ticks, phi);
            whole = advance(rod, whole, phi, rod.tick_s);
        }
        EXPECT_NEAR((by_ticks - whole).norm(), 0.0, 1e-9) << "seed 22, case " << k;
    }
}

TEST(ThermalRod, ThatConductsWell_IsThePair) {
    NoiseStream draw(23, "cases");
    for (int k = 0; k < 30; ++k) {
        const ThermalPair pair = drawn_pair(draw);
        const ThermalRod rod = thermal_rod(pair, 1e-6, 1e-3);
        const RodRise warm = advance(rod, RodRise::Zero(), 80.0, 5.0);
        const Eigen::Vector2d expected = advance(pair, Eigen::Vector2d::Zero(), 80.0, 5.0);
        EXPECT_NEAR(warm(0), expected(0), 1e-4) << "seed 23, case " << k;
        for (int part = 1; part <= rod_parts; ++part)
            EXPECT_NEAR(warm(part), expected(1), 1e-3) << "seed 23, case " << k;
    }
}

TEST(ThermalRod, FarEnd_WarmsLast) {
    const ThermalRod rod = thermal_rod({0.55, 1.0, 0.4, 15.0, 1.2}, 4.0, 1e-3);
    const RodRise warm = advance(rod, RodRise::Zero(), 80.0, 1.0);
    for (int part = 1; part < rod_parts; ++part) EXPECT_GT(warm(part), 1.5 * warm(part + 1));
    EXPECT_GT(warm(rod_parts), 0.0);
}

}  // namespace
}  // namespace fidservo::plant
