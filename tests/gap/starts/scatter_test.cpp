// SPDX-License-Identifier: GPL-3.0-or-later
// Piecewise constant losses: no gradient leads from one local minimum to the next.
#include "gap/starts/scatter.h"

#include "core/random.h"
#include "gap/candidates/wave.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::effects;

/// Neighbouring minima: a loss that is constant except near the truth, where it has a gradient.
TEST(Scatter, Spring_IsFoundWhereNoSlopeLeads) {
    const Hypothesis truth = effects({"cable_force:stiffness_V_per_mm=0.002,centre_mm=90,hardening=2"}),
                     start = effects({"cable_force:stiffness_V_per_mm=0.0025,centre_mm=80,hardening=1"});
    std::vector<Window> windows(1);
    windows.front().end = 1;
    const Predict predict = [&](const Hypothesis& hypothesis) {
        const auto& [stiffness, centre, hardening] =
            std::tie(hypothesis[0].values[0], hypothesis[0].values[1], hypothesis[0].values[2]);
        const double away =
            std::hypot(std::log(stiffness / truth[0].values[0]) / 0.2, (centre - truth[0].values[1]) / 10.0,
                       (hardening - truth[0].values[2]) / 1.0);
        return Errors{static_cast<float>(100.0 * (std::floor(4.0 * away) / 4.0 + 0.01 * away))};
    };
    const Fit found = scatter(predict, windows, {1}, start, {0});
    EXPECT_NEAR(found.hypothesis[0].values[0], 0.002, 2e-4);
    EXPECT_NEAR(found.hypothesis[0].values[1], 90.0, 4.0);
    EXPECT_NEAR(found.hypothesis[0].values[2], 2.0, 0.5);
}

/// The distance of two waves in those of their parameters that are drawn first.
std::array<double, 5> way_between(const plant::EffectSetting& one, const plant::EffectSetting& other) {
    constexpr double endless_mm = std::numeric_limits<double>::infinity();
    const auto middle_rad = [](const plant::EffectSetting& wave) {
        return phase_in_step(wave.values[2], wave.values[1], endless_mm);
    };
    return {std::log(other.values[0] / one.values[0]) / 0.35,
            (1.0 / other.values[1] - 1.0 / one.values[1]) / (0.175 / 200.0),
            std::remainder(middle_rad(other) - middle_rad(one), 2.0 * std::numbers::pi) / 0.35,
            (other.values[3] - one.values[3]) / 0.105, (other.values[4] - one.values[4]) / 0.105};
}

/// A carriage that in each window goes the right way where the wave is near enough in a direction of its own.
TEST(Scatter, WaveThatDecidesWaysAlone_IsFoundFromWhereAFewAreRight) {
    constexpr std::size_t ways = 60;
    constexpr unsigned seed = 5;
    NoiseStream noise(seed, "ways");
    struct Way {
        std::array<double, 5> direction{};
        double reach = 0.0;
    };
    std::vector<Way> all(ways);
    for (Way& way : all) {
        for (double& part : way.direction) part = noise.normal() / std::sqrt(5.0);
        way.reach = 0.02 + 0.4 * noise.uniform();
    }
    std::vector<Window> windows(ways);
    for (std::size_t w = 0; w < ways; ++w) {
        windows[w].begin = w;
        windows[w].end = w + 1;
    }
    const plant::EffectSetting truth =
        effects({"cogging:amplitude_V=0.014,period_mm=9,phase_rad=3.1,second_sine=0.2,second_cosine=-0.1"})
            .front();
    const Predict predict = [&](const Hypothesis& hypothesis) {
        const std::array<double, 5> from_truth = way_between(truth, hypothesis.front());
        Errors errors;
        for (const Way& way : all) {
            double along = 0.0;
            for (std::size_t k = 0; k < from_truth.size(); ++k) along += way.direction[k] * from_truth[k];
            errors.push_back(std::abs(along) < way.reach ? 0.5F : 40.0F);
        }
        return errors;
    };
    const Wanted counted(ways, 1);
    const auto wrong_ways = [&](const Hypothesis& hypothesis) {
        return std::ranges::count(predict(hypothesis), 40.0F);
    };
    std::ptrdiff_t wrong_at_start = 0, wrong_at_end = 0;
    int close = 0;
    constexpr int starts = 40;
    for (int start = 0; start < starts; ++start) {
        plant::EffectSetting beside = truth;
        beside.values[0] *= std::exp(0.2 * noise.normal());
        beside.values[1] = 1.0 / (1.0 / truth.values[1] + 5e-4 * noise.normal());
        beside.values[2] =
            phase_in_step(truth.values[2] + 0.2 * noise.normal(), truth.values[1], beside.values[1]);
        beside.values[3] += 0.06 * noise.normal();
        beside.values[4] += 0.06 * noise.normal();
        const Fit found = scatter(predict, windows, counted, {beside}, {0});
        wrong_at_start += wrong_ways({beside});
        wrong_at_end += wrong_ways(found.hypothesis);
        close += wrong_ways(found.hypothesis) <= 4 ? 1 : 0;
    }
    EXPECT_GT(wrong_at_start, 40 * starts) << "seed " << seed;
    EXPECT_LT(wrong_at_end, 8 * starts) << "seed " << seed;
    EXPECT_GT(close, starts / 2) << "seed " << seed;
}

}  // namespace

}  // namespace fidservo
