// SPDX-License-Identifier: GPL-3.0-or-later
// Losses of windows, comparisons of hypotheses, and what is no chance: against hand calculation, published
// tables of Student's law, and random draws.
#include "gap/fit/score.h"

#include "core/random.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

constexpr float not_counted = std::numeric_limits<float>::quiet_NaN();

/// Windows of `values` values each, `windows` of them in each of `runs` recordings.
std::vector<Window> windows_of(std::size_t runs, std::size_t windows, std::size_t values) {
    std::vector<Window> all;
    for (std::size_t run = 0; run < runs; ++run)
        for (std::size_t w = 0; w < windows; ++w) {
            Window window;
            window.run = run;
            window.begin = all.size() * values;
            window.end = window.begin + values;
            all.push_back(window);
        }
    return all;
}

TEST(Score, MeanSquares_AreThoseOfTheValuesThatCount) {
    const auto windows = windows_of(1, 3, 2);
    const auto squares = mean_squares(windows, {1.0F, 3.0F, not_counted, 2.0F, not_counted, not_counted});
    EXPECT_DOUBLE_EQ(squares[0], 5.0);
    EXPECT_DOUBLE_EQ(squares[1], 4.0);
    EXPECT_TRUE(std::isnan(squares[2]));
    EXPECT_DOUBLE_EQ(total_loss(squares), 0.5 * std::log(6.0) + 0.5 * std::log(5.0));
}

TEST(Score, ErrorsOfARefusedHypothesis_AreInfinitelyBad) {
    const auto windows = windows_of(1, 1, 2);
    EXPECT_EQ(total_loss(windows, {1}, {}), std::numeric_limits<double>::infinity());
}

TEST(Score, Comparison_CountsBlocksOfThreeWindowsOfOneRunAndSignal) {
    const auto windows = windows_of(2, 4, 1);  // blocks of 3, 1, 3, 1
    const std::vector<double> first(8, std::expm1(2.0)), second{0, 0, 0, 0, 0, 0, 0, std::expm1(2.0)};
    const Comparison comparison = compare(windows, first, second);
    EXPECT_DOUBLE_EQ(comparison.gain, 7.0);
    EXPECT_EQ(comparison.blocks, 3);  // the fourth does not differ
    // Gains 3, 1, 3: mean 7/3, variance 4/3, so 7 / sqrt(3 * 4/3).
    EXPECT_NEAR(comparison.significance, 7.0 / 2.0, 1e-12);
}

TEST(Score, Comparison_CountsEveryFrameByItself) {
    std::vector<Window> frames = windows_of(1, 4, 1);
    for (Window& frame : frames) frame.signal = Signal::image;
    const std::vector<double> first(4, std::expm1(2.0)), second{0, 0, 0, std::expm1(1.0)};
    const Comparison comparison = compare(frames, first, second);
    EXPECT_EQ(comparison.blocks, 4);
    // Gains 1, 1, 1, 1/2: mean 7/8, variance 1/16, so 7/2 / sqrt(4 / 16).
    EXPECT_NEAR(comparison.significance, 7.0, 1e-12);
}

TEST(Score, BoundIsStudents) {
    // t at one-sided 0.01 and 0.001 (Fisher and Yates, Statistical Tables, 6th ed., 1963).
    EXPECT_NEAR(significance_bound(11, 1, 0.01), 2.764, 0.01);
    EXPECT_NEAR(significance_bound(31, 1, 0.001), 3.385, 0.01);
    EXPECT_NEAR(significance_bound(31, 10, 0.01), 3.385, 0.01);
    EXPECT_EQ(significance_bound(3, 1, 0.01), std::numeric_limits<double>::infinity());
}

TEST(Score, ChanceGains_ExceedTheBoundAsOftenAsItSays) {
    constexpr std::uint64_t seed = 11;
    SCOPED_TRACE(seed);
    constexpr int draws = 4000, blocks = 20;
    constexpr double tail = 0.05;
    NoiseStream random(seed, "gains by chance");
    const auto windows = windows_of(blocks, 3, 1);
    int exceeded = 0;
    for (int draw = 0; draw < draws; ++draw) {
        std::vector<double> first, second;
        for (std::size_t w = 0; w < windows.size(); ++w) {
            first.push_back(std::exp(0.1 * random.normal()));
            second.push_back(std::exp(0.1 * random.normal()));
        }
        const Comparison comparison = compare(windows, first, second);
        exceeded += comparison.significance > significance_bound(comparison.blocks, 1, tail) ? 1 : 0;
    }
    const double expected = tail * draws;
    EXPECT_NEAR(exceeded, expected, 4.0 * std::sqrt(expected * (1.0 - tail)));
}

}  // namespace

}  // namespace fidservo
