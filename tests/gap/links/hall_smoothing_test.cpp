// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/hall_smoothing.h"

#include "core/random.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

constexpr double noise_lsb = 0.4, tick_s = 1e-3;
constexpr std::uint64_t seed = 17;

/// Readings of a course with noise, rounded.
template <class Lsb>
PlatformRun readings(std::size_t rows, Lsb course_lsb) {
    NoiseStream noise(seed, "hall");
    PlatformRun run;
    run.tick_s = tick_s;
    run.floor_lsb = std::sqrt(noise_lsb * noise_lsb + 1.0 / 12.0);
    run.command_V.assign(rows, 0.0);
    run.macro_command_V.assign(rows, 0.0);
    run.ticks.assign(rows, 1);
    for (std::size_t k = 0; k < rows; ++k)
        run.hall_adc.push_back(std::floor(course_lsb(k) + noise_lsb * noise.normal() + 0.5));
    return run;
}

PlatformPrediction path_of(std::vector<double> path_lsb) {
    return {{}, std::move(path_lsb), {}, {}};
}

/// R.m.s. of (smoothed - true) per stated standard deviation.
template <class Lsb>
double stds_off(const PlatformRun& run, const std::vector<double>& model_lsb, Lsb course_lsb) {
    const SmoothedReading smoothed = smoothed_reading(run, path_of(model_lsb), 5.0);
    double sum = 0.0;
    for (std::size_t k = 0; k < run.hall_adc.size(); ++k)
        sum += std::pow((smoothed.reading_lsb[k] - course_lsb(k)) / smoothed.std_lsb[k], 2);
    return std::sqrt(sum / static_cast<double>(run.hall_adc.size()));
}

TEST(HallSmoothing, CourseThatTheModelKnows_NoiseGoesDownTenfold) {
    const auto course = [](std::size_t k) {
        return 1500.0 + 300.0 * std::sin(0.02 * static_cast<double>(k));
    };
    const PlatformRun run = readings(20'000, course);
    std::vector<double> model;
    for (std::size_t k = 0; k < run.hall_adc.size(); ++k) model.push_back(course(k));
    const SmoothedReading smoothed = smoothed_reading(run, path_of(model), 5.0);
    double sum = 0.0;
    for (std::size_t k = 0; k < run.hall_adc.size(); ++k)
        sum += std::pow(smoothed.reading_lsb[k] - course(k), 2);
    EXPECT_LT(std::sqrt(sum / 20'000.0), 0.1 * run.floor_lsb * 1.5) << "seed " << seed;
    EXPECT_LT(stds_off(run, model, course), 1.2) << "seed " << seed;
}

TEST(HallSmoothing, WhatItsErrorChangesBy_IsAsStated) {
    const auto course = [](std::size_t) { return 1500.3; };
    const PlatformRun run = readings(20'000, course);
    const SmoothedReading smoothed =
        smoothed_reading(run, path_of(std::vector(run.hall_adc.size(), 1500.3)), 5.0);
    for (const std::size_t ticks : {3, 30, 3000}) {
        double sum = 0.0;
        for (std::size_t k = 0; k + ticks < run.hall_adc.size(); ++k)
            sum += std::pow((smoothed.reading_lsb[k + ticks] - smoothed.reading_lsb[k]) /
                                changed_lsb(smoothed, k, k + ticks),
                            2);
        const double stds = std::sqrt(sum / static_cast<double>(run.hall_adc.size() - ticks));
        EXPECT_GT(stds, 0.6) << ticks << " ticks, seed " << seed;
        EXPECT_LT(stds, 1.2) << ticks << " ticks, seed " << seed;
    }
}

TEST(HallSmoothing, SwingThatTheModelDoesNotKnow_IsKept) {
    const auto course = [](std::size_t k) {
        return 1500.0 + 10.0 * std::sin(2.0 * std::numbers::pi * 30.0 * tick_s * static_cast<double>(k));
    };
    const PlatformRun run = readings(20'000, course);
    const std::vector<double> model(run.hall_adc.size(), 1500.0);
    EXPECT_LT(stds_off(run, model, course), 2.5) << "seed " << seed;
}

TEST(HallSmoothing, MissingReadings_AreHeld) {
    PlatformRun run = readings(600, [](std::size_t) { return 1500.0; });
    for (std::size_t k = 200; k < 300; ++k) run.hall_adc[k] = std::numeric_limits<double>::quiet_NaN();
    const SmoothedReading smoothed = smoothed_reading(run, path_of(std::vector<double>(600, 1500.0)), 5.0);
    EXPECT_EQ(smoothed.reading_lsb[250], smoothed.reading_lsb[199]);
    const PlatformRun none = readings(0, [](std::size_t) { return 0.0; });
    EXPECT_TRUE(smoothed_reading(none, path_of({}), 5.0).reading_lsb.empty());
}

}  // namespace

}  // namespace fidservo
