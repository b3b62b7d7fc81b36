// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/rounding_likelihood.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

TEST(RoundingLoss, PlacesWithinTheCount_AreEquallyGood) {
    for (const double error : {-0.3, -0.1, 0.0, 0.2, 0.3}) {
        const RoundingLoss loss = rounding_loss(error, 0.02);
        EXPECT_NEAR(loss.value, 0.0, 1e-9) << error;
        EXPECT_NEAR(loss.slope, 0.0, 1e-9) << error;
    }
    EXPECT_NEAR(rounding_loss(0.5, 0.02).value, std::log(2.0), 1e-9);
}

TEST(RoundingLoss, MuchNoise_IsTheNormalLaw) {
    const double noise = 50.0, error = 30.0, variance = noise * noise + 1.0 / 12.0;
    const RoundingLoss loss = rounding_loss(error, noise);
    EXPECT_NEAR(loss.value,
                0.5 * error * error / variance + 0.5 * std::log(2.0 * std::numbers::pi * variance), 1e-12);
    EXPECT_NEAR(loss.slope, error / variance, 1e-15);
}

TEST(RoundingLoss, Probabilities_AddUpToOne) {
    for (const double noise : {0.05, 0.3, 1.0, 1.9, 2.1, 8.0}) {
        for (const double place : {0.0, 0.17, 0.5}) {
            double sum = 0.0;
            for (int count = -100; count <= 100; ++count)
                sum += std::exp(-rounding_loss(place - count, noise).value);
            EXPECT_NEAR(sum, 1.0, 1e-6) << "noise " << noise << " place " << place;
        }
    }
}

TEST(RoundingLoss, Derivatives_AreThoseOfTheValue) {
    constexpr double step = 1e-5;
    for (const double noise : {0.05, 0.3, 1.0, 3.0}) {
        for (const double error : {-4.0, -0.61, -0.5, 0.1, 0.45, 0.7, 1.9, 12.0}) {
            const RoundingLoss below = rounding_loss(error - step, noise), here = rounding_loss(error, noise),
                               above = rounding_loss(error + step, noise);
            const double slope = (above.value - below.value) / (2.0 * step);
            const double curvature = (above.slope - below.slope) / (2.0 * step);
            EXPECT_NEAR(here.slope, slope, 1e-3 * std::abs(slope) + 1e-6) << noise << ' ' << error;
            EXPECT_NEAR(here.curvature, curvature, 5e-3 * std::abs(curvature) + 1e-4)
                << noise << ' ' << error;
            EXPECT_GE(here.curvature, 0.0);
        }
    }
}

TEST(RoundingLoss, Value_IsThatOfBothTails_AlsoAlone) {
    for (const double noise : {0.05, 0.11, 0.3, 1.0, 1.9})
        for (double error = -1.5; error <= 1.5; error += 0.013) {
            if ((std::abs(error) - 0.5) / noise > 6.0) continue;
            const auto tail = [&](double edge) {
                return 0.5L *
                       std::erfc(static_cast<long double>(edge / noise) / std::numbers::sqrt2_v<long double>);
            };
            const long double probability = tail(std::abs(error) - 0.5) - tail(std::abs(error) + 0.5);
            const auto expected = static_cast<double>(-std::log(probability));
            EXPECT_NEAR(rounding_loss(error, noise).value, expected, 1e-13 * (1.0 + expected))
                << "noise " << noise << " error " << error;
            EXPECT_EQ(rounding_loss_value(error, noise), rounding_loss(error, noise).value);
        }
    for (const double noise : {0.05, 1.0, 5.0})
        for (const double error : {-40.0, -7.0, 8.0})
            EXPECT_EQ(rounding_loss_value(error, noise), rounding_loss(error, noise).value);
}

}  // namespace
}  // namespace fidservo::calib
