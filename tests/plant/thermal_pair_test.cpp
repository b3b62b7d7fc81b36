// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/thermal_pair.h"

#include "core/random.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

/// A random pair whose mass takes more or less heat than it gives back.
ThermalPair drawn_pair(NoiseStream& draw, double least_mass_tau_s) {
    const double taken = 2.0 * draw.uniform();
    const double most_coupling = taken < 1.0 ? std::min(2.0, 0.8 / (1.0 - taken)) : 2.0;
    return {0.3 + draw.uniform(),
            0.3 + draw.uniform(),
            most_coupling * draw.uniform(),
            least_mass_tau_s + 10.0 * draw.uniform(),
            taken,
            1.0 + draw.uniform()};
}

/// Runge-Kutta of the fourth order on the equations as they stand, the regime chosen anew at every step.
Eigen::Vector2d integrate(const ThermalPair& pair, Eigen::Vector2d y, double phi, double time_s, int steps) {
    const double around = pair.coupling * std::max(0.0, 1.0 - pair.taken);
    const auto slope = [&](const Eigen::Vector2d& at) {
        const double lacks = phi - at.x() + around * at.y();
        const bool heats = lacks > 0.0;
        return Eigen::Vector2d(lacks / (heats ? pair.heating_tau_s : pair.cooling_tau_s) -
                                   (pair.coupling - around) * (heats ? pair.heating : 1.0) /
                                       pair.cooling_tau_s * (std::max(1.0, pair.taken) * at.x() - at.y()),
                               (at.x() - at.y()) / pair.mass_tau_s);
    };
    const double h = time_s / steps;
    for (int k = 0; k < steps; ++k) {
        const Eigen::Vector2d a = slope(y), b = slope(y + 0.5 * h * a), c = slope(y + 0.5 * h * b),
                              d = slope(y + h * c);
        y += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
    return y;
}

TEST(ThermalPair, Cooling_IsTheSumOfTwoExponentials) {
    const ThermalPair pair{0.55, 1.0, 0.4, 15.0};
    // Rates of tau = 1, a = 0.4, tau_b = 15, r = 1 by hand: l^2 + (1.4 + 1/15) l + 1/15 = 0.
    const double sum = 1.4 + 1.0 / 15.0, product = 1.0 / 15.0;
    const double fast = 0.5 * (sum + std::sqrt(sum * sum - 4.0 * product)), slow = product / fast;
    const Eigen::Vector2d start(90.0, 30.0);
    // q = P exp(-fast t) + Q exp(-slow t), with q(0) and q'(0) = -1.4 q + 0.4 b.
    const double slope = -1.4 * 90.0 + 0.4 * 30.0;
    const double P = -(slope + slow * 90.0) / (fast - slow), Q = 90.0 - P;
    EXPECT_GT(Q, 1.0) << "what slows the cooling later on";
    for (const double t : {0.001, 0.3, 2.0, 10.0, 60.0})
        EXPECT_NEAR(advance(pair, start, 0.0, t).x(), P * std::exp(-fast * t) + Q * std::exp(-slow * t),
                    1e-11)
            << t;
}

TEST(ThermalPair, WithoutCoupling_IsTheSingleWire) {
    const ThermalPair pair{0.55, 1.0, 0.0, 20.0};
    EXPECT_NEAR(advance(pair, {0.0, 0.0}, 100.0, 0.3).x(), 100.0 * (1.0 - std::exp(-0.3 / 0.55)), 1e-11);
    EXPECT_NEAR(advance(pair, {100.0, 5.0}, 20.0, 0.3).x(), 20.0 + 80.0 * std::exp(-0.3), 1e-11);
}

TEST(ThermalPair, EqualRates_AreNoSpecialCase) {
    const ThermalPair pair{1.0, 1.0, 0.0, 1.0};
    const Eigen::Vector2d after = advance(pair, {10.0, 3.0}, 0.0, 0.7);
    EXPECT_NEAR(after.x(), 10.0 * std::exp(-0.7), 1e-12);
    EXPECT_NEAR(after.y(), (3.0 + 0.7 * 10.0) * std::exp(-0.7), 1e-12);
}

TEST(ThermalPair, HeldForLong_SettlesAtTheEquilibrium) {
    const ThermalPair loses{0.55, 1.0, 0.5, 20.0, 1.2};
    const Eigen::Vector2d after = advance(loses, {0.0, 0.0}, 110.0, 1e4);
    // Below phi, in the heating regime: (phi - q) / 0.55 = 0.5 / 1.0 (1.2 q - q).
    EXPECT_NEAR(after.x(), 110.0 / (1.0 + 0.55 * 0.5 * 0.2), 1e-9);
    EXPECT_NEAR(after.y(), after.x(), 1e-9);
    const ThermalPair surrounds{0.55, 1.0, 0.1, 8.0, 0.0};
    EXPECT_NEAR(advance(surrounds, {0.0, 0.0}, 90.0, 1e4).x(), 100.0, 1e-9) << "phi - q + 0.1 q = 0";
}

TEST(ThermalPair, OneLongStep_IsTheSameAsManyShortOnes) {
    NoiseStream draw(11, "cases");
    for (int k = 0; k < 200; ++k) {
        const ThermalPair pair = drawn_pair(draw, 0.5);
        const Eigen::Vector2d start(100.0 * draw.uniform(), 100.0 * draw.uniform());
        const double phi = 120.0 * draw.uniform(), time_s = 3.0 * draw.uniform();
        Eigen::Vector2d many = start;
        for (int i = 0; i < 1000; ++i) many = advance(pair, many, phi, time_s / 1000);
        EXPECT_NEAR((advance(pair, start, phi, time_s) - many).norm(), 0.0, 1e-9) << "seed 11, case " << k;
    }
}

TEST(ThermalPair, WireThatPassesItsGoal_SolvesTheEquationsInBothRegimes) {
    // A hotter or colder mass takes the wire beyond the temperature that the command alone would reach.
    NoiseStream draw(13, "cases");
    int passed = 0;
    for (int k = 0; k < 40; ++k) {
        ThermalPair pair = drawn_pair(draw, 1.0);
        pair.heating_tau_s = 0.55;
        pair.cooling_tau_s = 1.0;
        const bool jumps = k % 2 == 1;
        if (!jumps) pair.heating = 1.0;
        const Eigen::Vector2d start(50.0 + 20.0 * draw.uniform(), 160.0 * draw.uniform());
        const double phi = 60.0;
        const Eigen::Vector2d expected = integrate(pair, start, phi, 2.0, 200000);
        passed += (phi - start.x()) * (phi - expected.x()) < 0.0 ? 1 : 0;
        // A step of 1e-5 s across phi makes an error of first order where the rate jumps, and a smaller one
        // elsewhere.
        EXPECT_NEAR((advance(pair, start, phi, 2.0) - expected).norm(), 0.0, jumps ? 1e-5 : 1e-6)
            << "seed 13, case " << k;
    }
    EXPECT_GE(passed, 5);
}

TEST(ThermalPair, TickByTick_IsTheSameAsTheClosedForm) {
    NoiseStream draw(14, "cases");
    for (int k = 0; k < 50; ++k) {
        const ThermalPair pair = drawn_pair(draw, 0.05);
        const ThermalPairTick tick = thermal_pair_tick(pair, 0.02);
        Eigen::Vector2d by_ticks(100.0 * draw.uniform(), 150.0 * draw.uniform()), whole = by_ticks;
        for (int i = 0; i < 200; ++i) {
            const double phi = i % 40 < 20 ? 80.0 : 40.0;
            by_ticks = advance(tick, by_ticks, phi);
            whole = advance(pair, whole, phi, tick.time_s);
        }
        EXPECT_NEAR((by_ticks - whole).norm(), 0.0, 1e-10) << "seed 14, case " << k;
    }
}

}  // namespace
}  // namespace fidservo::plant
