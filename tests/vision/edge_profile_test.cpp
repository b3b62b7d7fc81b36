// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/edge_profile.h"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace fidservo::vision {
namespace {

/// f0 .. f5 at one place.
std::array<double, 6> profile(double z, double half) {
    Lanes places = {};
    places += static_cast<float>(z);
    EdgeProfile f;
    profile_at(places, static_cast<float>(half), f);
    return {f.f0[0], f.f1[0], f.f2[0], f.f3[0], f.f4[0], f.f5[0]};
}

/// The same in double precision, by Hermite's recursion He(n+1) = z He(n) - n He(n-1).
std::array<double, 6> exact(double z) {
    const double density = std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
    std::array<double, 6> f{0.5 * std::erfc(-z / std::numbers::sqrt2)};
    double before = 0.0, hermite = 1.0, sign = 1.0;
    for (int n = 1; n <= 5; ++n) {
        f[n] = sign * hermite * density;
        const double next = z * hermite - (n - 1) * before;
        before = hermite;
        hermite = next;
        sign = -sign;
    }
    return f;
}

TEST(EdgeProfile, OfAStillEdge_IsTheNormalDistributionAndItsDerivatives) {
    for (double z = -9.0; z <= 9.0; z += 0.0371)
        for (int n = 0; n < 6; ++n)
            EXPECT_NEAR(profile(z, 0.0)[n], exact(z)[n], 2e-6) << "f" << n << " at " << z;
}

TEST(EdgeProfile, OfAMovingEdge_IsTheMeanAlongTheWay) {
    constexpr int steps = 400;
    for (const double half : {0.4, 1.7, 3.0})
        for (double z = -5.0; z <= 5.0; z += 0.173) {
            std::array<double, 6> mean{};
            for (int k = 0; k < steps; ++k)
                for (int n = 0; n < 6; ++n)
                    mean[n] += exact(z + half * ((2.0 * k + 1.0) / steps - 1.0))[n] / steps;
            for (int n = 0; n < 6; ++n)
                EXPECT_NEAR(profile(z, half)[n], mean[n], 2e-5)
                    << "f" << n << " at " << z << ", half " << half;
        }
}

TEST(Lanes, InverseRoot_IsRightToItsPromise) {
    for (double x = 1e-3; x < 1e4; x *= 1.13) {
        Lanes values = {};
        values += static_cast<float>(x);
        Lanes roots;
        inverse_root(values, roots);
        EXPECT_NEAR(static_cast<double>(roots[3]) * std::sqrt(x), 1.0, 5e-6) << x;
    }
}

}  // namespace
}  // namespace fidservo::vision
