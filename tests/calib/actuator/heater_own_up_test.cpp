// SPDX-License-Identifier: GPL-3.0-or-later
// The answer of identify heater if recordings contradict each other, determine only a combination, or are not
// explained by the model.
#include "calib/significance.h"
#include "calib/tails.h"
#include "calib/wire/heater_fit.h"
#include "core/random.h"
#include "core/result.h"
#include "tests/effort.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

constexpr HeaterParameters wire{0.4, 10.0, 6.0, 12.0, 25.0, 22.0};

/// Steps of four heights, heated and cooled for `half_s` each, read by a thermometer with autocorrelated
/// noise.
HeaterRun heated(const HeaterParameters& heater, double half_s, std::uint64_t seed, double memory = 0.0,
                 double noise_degC = 0.1) {
    constexpr double tick_s = 0.5;
    HeaterRun run{.tick_s = tick_s, .command = {}, .reading = {}};
    const auto half = static_cast<int>(half_s / tick_s);
    for (int k = 0; k < 8 * half; ++k) {
        const int step = k / half;
        run.command.push_back(step % 2 == 0 ? 1.0 + 0.2 * step : 0.0);
    }
    run.reading = predict_temperature(heater, run);
    run.start_degC = run.reading.front();
    NoiseStream noise(seed, "thermometer");
    double state = noise.normal();
    for (double& value : run.reading) {
        value += noise_degC * state;
        state = memory * state + std::sqrt(1.0 - memory * memory) * noise.normal();
    }
    return run;
}

std::array<double, heater_numbers> numbers_of(const HeaterParameters& heater) {
    return {heater.onset_V, heater.gain_degC_per_V, heater.heating_tau_s, heater.cooling_tau_s,
            heater.ambient_degC};
}

TEST(SlowHeaterIntervals, WhiteAndCorrelatedNoise_AreCovered) {
    const int campaigns = testing::draws(150, 50);
    for (const double memory : {0.0, 0.8}) {
        int hits = 0, stated = 0;
        for (int seed = 1; seed <= campaigns; ++seed) {
            const auto fit =
                fit_heater_to_temperature({heated(wire, 40.0, static_cast<std::uint64_t>(seed), memory)});
            ASSERT_TRUE(fit) << fit.error().text;
            const auto found = numbers_of(fit->heater), truth = numbers_of(wire);
            for (std::size_t i = 0; i < heater_numbers; ++i) {
                if (!std::isfinite(fit->std[i])) continue;
                ++stated;
                hits += std::abs(found[i] - truth[i]) <= student_bound(fit->freedom[i], 0.05) * fit->std[i];
            }
        }
        const double share = static_cast<double>(hits) / stated;
        fmt::print("coverage of 95 % intervals | heater, noise of correlation {} | {:.1f} % of {}\n", memory,
                   100.0 * share, stated);
        // The five numbers of a campaign are not independent, so the interval is that of as many values as
        // there are campaigns.
        const double reach = normal_bound(0.0005) * std::sqrt(0.95 * 0.05 / campaigns);
        EXPECT_NEAR(share, 0.95, reach);
    }
}

TEST(HeaterOwnsUp, GainThatDiffersBetweenRecordings_IsNamed) {
    HeaterParameters other = wire;
    other.gain_degC_per_V = 10.5;
    const auto fit = fit_heater_to_temperature({heated(wire, 40.0, 1), heated(other, 40.0, 2)});
    ASSERT_TRUE(fit) << fit.error().text;
    const auto found =
        std::ranges::find(fit->contradictions, HeaterNumber::gain, &HeaterContradiction::number);
    ASSERT_NE(found, fit->contradictions.end());
    EXPECT_GT(found->apart, 4.0);
    EXPECT_EQ(found->low, 0U);
    EXPECT_EQ(found->high, 1U);
}

TEST(HeaterOwnsUp, RecordingsWithoutACommonSolution_AreToldApart) {
    HeaterParameters other = wire;
    other.gain_degC_per_V = 14.0;
    const auto fit = fit_heater_to_temperature({heated(wire, 40.0, 1), heated(other, 40.0, 2)});
    const std::string said =
        fit ? (fit->contradictions.empty() ? "" : "contradict each other") : fit.error().text;
    EXPECT_NE(said.find("contradict each other"), std::string::npos) << said;
}

}  // namespace
}  // namespace fidservo::calib
