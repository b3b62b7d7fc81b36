// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/smooth_function.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace fidservo::reference {
namespace {

SmoothFunction some_function(double size) {
    std::array<double, smooth_waves> wave_numbers{}, phases_rad{};
    for (std::size_t i = 0; i < smooth_waves; ++i) {
        wave_numbers[i] = 0.5 + 0.7 * static_cast<double>(i);
        phases_rad[i] = static_cast<double>(i * i);
    }
    return smooth_function(size, 20.0, 60.0, wave_numbers, phases_rad);
}

TEST(SmoothFunction, OverItsRange_HasItsSizeAndNoLine) {
    const SmoothFunction function = some_function(0.3);
    constexpr int points = 4001;
    double mean = 0.0, moment = 0.0, square = 0.0;
    for (int k = 0; k < points; ++k) {
        const double u = 2.0 * k / (points - 1) - 1.0, value = function(40.0 + 20.0 * u);
        mean += value / points;
        moment += u * value / points;
        square += value * value / points;
    }
    EXPECT_NEAR(std::sqrt(square), 0.3, 3e-3);
    EXPECT_NEAR(mean, 0.0, 2e-3);
    EXPECT_NEAR(moment, 0.0, 2e-3);
}

/// With equal wave numbers and phases the function is one cosine minus its mean, which is sin(k) / k over
/// -1..1, scaled to an r.m.s. of 2.
TEST(SmoothFunction, OneWave_IsTheCosineLessItsMean) {
    constexpr double k = std::numbers::pi / 2.0;
    std::array<double, smooth_waves> wave_numbers{};
    wave_numbers.fill(k);
    const SmoothFunction function = smooth_function(2.0, -1.0, 1.0, wave_numbers, {});
    const double mean = std::sin(k) / k;
    const double variance = 0.5 + std::sin(2.0 * k) / (4.0 * k) - mean * mean;
    for (const double u : {-1.0, 0.0, 0.4})
        EXPECT_NEAR(function(u), 2.0 * (std::cos(k * u) - mean) / std::sqrt(variance), 0.02);
}

TEST(SmoothFunction, WithoutSize_IsNothing) {
    EXPECT_EQ(some_function(0.0)(33.0), 0.0);
    EXPECT_EQ(SmoothFunction{}(1.0), 0.0);
}

}  // namespace
}  // namespace fidservo::reference
