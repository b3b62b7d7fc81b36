// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/predictive_density.h"

#include "tests/gap/equal_windows.h"
#include "tests/gap/simulated_campaign.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

/// If all windows have the same square, Student's distribution is most probable at a variance equal to it,
/// whatever its size.
TEST(Discrepancy, WhereEveryWindowIsOffByTheSame_IsWhatThatExceedsTheNoiseBy) {
    std::vector<Window> windows = testing::equal_windows(40, 10);
    for (std::size_t w = 20; w < 40; ++w) {
        windows[w].signal = Signal::hall;
        windows[w].expected_square = 0.25;
    }
    std::vector<double> squares(40, 1.0 + 9.0);
    for (std::size_t w = 20; w < 40; ++w) squares[w] = 0.25 + 4.0;
    squares[3] = std::numeric_limits<double>::quiet_NaN();
    const Discrepancy level = discrepancy_of(windows, squares);
    EXPECT_NEAR(level[index_of(Signal::encoder)], 3.0, 0.05 * 3.0);
    EXPECT_NEAR(level[index_of(Signal::hall)], 2.0, 0.05 * 2.0);
    EXPECT_EQ(level[index_of(Signal::tag)], 0.0);
}

TEST(Discrepancy, OfNoise_IsNone_AndAFewWindowsThatRanAway_DoNotMakeOne) {
    const std::vector<Window> windows = testing::equal_windows(40, 10);
    std::vector<double> squares(40, 1.0);
    EXPECT_EQ(discrepancy_of(windows, squares)[0], 0.0);
    squares[7] = squares[8] = 1e6;
    EXPECT_LT(discrepancy_of(windows, squares)[0], 1.0);  // r.m.s.: 224
}

/// log p of a window by its definition.
double log_p(double square, double variance) {
    return -0.5 * std::log(variance) - 2.5 * std::log1p(square / (4.0 * variance));
}

/// Squares at the floor in all windows of one signal of a campaign; NaN elsewhere.
struct OneSignal {
    Evidence evidence = testing::campaign({}, {"macro-pulses"});
    Wanted counted = Wanted(evidence.windows().size(), 0);
    std::vector<double> at_floor, far_off;
    std::vector<double> windows_of_run = std::vector<double>(evidence.recordings().size(), 0.0);

    explicit OneSignal(double square_off) {
        constexpr double not_judged = std::numeric_limits<double>::quiet_NaN();
        at_floor.assign(counted.size(), not_judged);
        far_off.assign(counted.size(), not_judged);
        for (std::size_t w = 0; w < counted.size(); ++w) {
            const Window& window = evidence.windows()[w];
            if (window.signal != Signal::encoder) continue;
            counted[w] = 1;
            at_floor[w] = window.expected_square;
            far_off[w] = square_off;
            windows_of_run[window.run] += 1.0;
        }
    }
};

TEST(LogDensities, OfIndependentWindows_AddUp) {
    const OneSignal here(100.0);
    const std::vector<double> of_floor = log_densities(here.evidence, here.at_floor, here.counted, {});
    std::vector<double> expected(of_floor.size(), 0.0);
    for (std::size_t w = 0; w < here.counted.size(); ++w) {
        const Window& window = here.evidence.windows()[w];
        if (here.counted[w] != 0)
            expected[window.run] += log_p(window.expected_square, window.expected_square);
    }
    for (std::size_t run = 0; run < expected.size(); ++run) {
        EXPECT_GT(here.windows_of_run[run], 3.0);
        EXPECT_NEAR(of_floor[run], expected[run], 1e-9);
    }
}

TEST(LogDensities, WhereADiscrepancyConnectsARecording_ItCountsAsOneWindow) {
    const OneSignal here(100.0);
    constexpr Discrepancy none{}, overwhelming{1e6};
    const std::vector<double> apart = log_densities(here.evidence, here.far_off, here.counted, none),
                              connected =
                                  log_densities(here.evidence, here.far_off, here.counted, overwhelming);
    for (std::size_t run = 0; run < apart.size(); ++run)
        EXPECT_NEAR(connected[run], apart[run] / here.windows_of_run[run], 1e-6 * std::abs(apart[run]));
}

TEST(LogDensities, WhatExplainsMore_IsMoreProbable_ThoughAnyLevelOfDiscrepancyMayBeHad) {
    const OneSignal little(4.0), much(400.0);
    const auto sum = [](const std::vector<double>& values) {
        return std::accumulate(values.begin(), values.end(), 0.0);
    };
    const double floor = sum(log_densities(little.evidence, little.at_floor, little.counted, {})),
                 near = sum(log_densities(little.evidence, little.far_off, little.counted, {})),
                 far = sum(log_densities(much.evidence, much.far_off, much.counted, {}));
    EXPECT_GT(floor, near);
    EXPECT_GT(near, far);
}

}  // namespace

}  // namespace fidservo
