// SPDX-License-Identifier: GPL-3.0-or-later
// Fits of what depends on a parameter by jumps.
#include "gap/fit/polish.h"

#include "plant/effects/catalogue.h"
#include "tests/gap/equal_windows.h"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

constexpr std::size_t windows_count = 10, values = 50;

const std::vector<Window> windows = testing::equal_windows(windows_count, values);

/// A window's errors jump whenever the amplitude passes a place of its own: between jumps no derivative says
/// where the truth lies.
Errors jumping(const Hypothesis& hypothesis) {
    constexpr double truth_V = 0.0512;
    const double amplitude_V = hypothesis.back().values.front();
    Errors errors(windows_count * values);
    for (std::size_t w = 0; w < windows_count; ++w) {
        const double jump_V = 0.001 * (1.0 + 0.1 * static_cast<double>(w));
        const double jumps = std::floor(amplitude_V / jump_V) - std::floor(truth_V / jump_V);
        for (std::size_t k = 0; k < values; ++k)
            errors[w * values + k] = static_cast<float>(jumps * std::sin(0.3 * static_cast<double>(k)));
    }
    return errors;
}

TEST(Polish, GoesOverJumps_WhereDerivativesStandStill) {
    const Hypothesis start{plant::parse_effect("cogging:amplitude_V=0.06,period_mm=5,phase_rad=1")};
    const Wanted all(windows_count, 1);
    const Fit by_derivatives = fit(jumping, windows, all, start);
    const Fit polished = polish(jumping, windows, all, start, {0});
    EXPECT_LT(polished.loss, 0.3 * by_derivatives.loss);
    EXPECT_NEAR(polished.hypothesis.back().values.front(), 0.0512, 0.001);
}

TEST(Polish, OfOneParameter_GoesOverJumpsToo) {
    const auto jumping_gain = [](const Hypothesis& hypothesis) {
        const double factor = hypothesis.back().values.front();
        return jumping({plant::parse_effect(fmt::format("cogging:amplitude_V={}", factor - 1.0))});
    };
    const Hypothesis start{plant::parse_effect("drive_gain:factor=1.06")};
    const Fit polished = polish(jumping_gain, windows, Wanted(windows_count, 1), start, {0});
    EXPECT_NEAR(polished.hypothesis.back().values.front(), 1.0512, 0.001);
}

TEST(Polish, ChangesNothingElse_AndKeepsAStartThatNothingBetters) {
    const Hypothesis start{plant::parse_effect("drive_gain:factor=1.1"),
                           plant::parse_effect("cogging:amplitude_V=0.0512,period_mm=5,phase_rad=1")};
    const Fit polished = polish(jumping, windows, Wanted(windows_count, 1), start, {1});
    EXPECT_EQ(polished.hypothesis.front().values.front(), 1.1);
    EXPECT_EQ(polished.hypothesis.back().values, start.back().values);
    EXPECT_EQ(polished.loss, 0.0);
}

/// Two effects whose sum the errors depend on, and their difference.
TEST(Polish, OfTwoEffects_ChangesThemTogether) {
    const auto sum_and_difference = [](const Hypothesis& hypothesis) {
        const double one = hypothesis[0].values.front() - 1.1, other = hypothesis[1].values.front() - 0.05;
        Errors errors(windows_count * values);
        for (std::size_t k = 0; k < errors.size(); ++k)
            errors[k] = static_cast<float>(k % 2 == 0 ? 1000.0 * (one + other) : 100.0 * (one - other));
        return errors;
    };
    const Hypothesis start{plant::parse_effect("drive_gain:factor=1.13"),
                           plant::parse_effect("drive_offset:offset_V=0.02")};
    const Wanted all(windows_count, 1);
    const Fit alone = polish(sum_and_difference, windows, all, start, {1});
    const Fit together = polish(sum_and_difference, windows, all, start, {0, 1});
    EXPECT_LT(together.loss, 0.2 * alone.loss);
    EXPECT_NEAR(together.hypothesis[0].values.front(), 1.1, 0.005);
    EXPECT_NEAR(together.hypothesis[1].values.front(), 0.05, 0.005);
}

}  // namespace

}  // namespace fidservo
