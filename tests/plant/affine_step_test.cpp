// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/affine_step.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

TEST(AffineStep, CarriageUnderDrag_MovesByItsClosedForm) {
    constexpr double tau_s = 0.02, h_s = 1e-3;
    const SquareMatrix<2> step = affine_step<2>({{{0.0, 1.0}, {0.0, -1.0 / tau_s}}}, h_s);
    const double slowed_s = tau_s * -std::expm1(-h_s / tau_s);
    EXPECT_NEAR(step[0][0], h_s, 1e-18);
    EXPECT_NEAR(step[0][1], tau_s * (h_s - slowed_s), 1e-17);
    EXPECT_EQ(step[1][0], 0.0);
    EXPECT_NEAR(step[1][1], slowed_s, 1e-17);
}

TEST(AffineStep, Swing_TurnsByItsClosedForm) {
    constexpr double w_rad_per_s = 300.0, h_s = 2e-3;
    const SquareMatrix<2> step = affine_step<2>({{{0.0, 1.0}, {-w_rad_per_s * w_rad_per_s, 0.0}}}, h_s);
    const double sine = std::sin(w_rad_per_s * h_s), cosine = std::cos(w_rad_per_s * h_s);
    EXPECT_NEAR(step[0][0], sine / w_rad_per_s, 1e-15);
    EXPECT_NEAR(step[0][1], (1.0 - cosine) / (w_rad_per_s * w_rad_per_s), 1e-17);
    EXPECT_NEAR(step[1][0], cosine - 1.0, 1e-14);
    EXPECT_NEAR(step[1][1], sine / w_rad_per_s, 1e-15);
}

TEST(AffineStep, FourIntegratorsInARow_GiveThePowersOfTime) {
    constexpr double h_s = 0.5;
    SquareMatrix<4> rates{};
    for (std::size_t i = 0; i + 1 < 4; ++i) rates[i][i + 1] = 1.0;
    const SquareMatrix<4> step = affine_step<4>(rates, h_s);
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < 4; ++k) {
            const double power = static_cast<double>(k) - static_cast<double>(i) + 1.0;
            const double expected = power < 1.0 ? 0.0 : std::pow(h_s, power) / std::tgamma(power + 1.0);
            EXPECT_NEAR(step[i][k], expected, 1e-15) << i << ", " << k;
        }
}

}  // namespace
}  // namespace fidservo::plant
