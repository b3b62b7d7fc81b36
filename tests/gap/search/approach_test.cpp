// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/approach.h"

#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

/// What an approach comes to where every error in the windows of a recording is a function of one size.
struct OfOneSize {
    Evidence evidence = testing::campaign({}, {"macro-pulses"});
    std::vector<Candidate> all = candidates(evidence, {}, {});

    const Candidate& named(std::string_view name) const {
        return *std::ranges::find_if(all, [&](const Candidate& one) { return one.effect->name == name; });
    }

    Approach from_none(const Candidate& candidate, const std::function<double(double)>& error) const {
        const Predict predict = [&](const Hypothesis& settings) {
            return Errors(evidence.windows().back().end,
                          static_cast<float>(error(settings.front().values.front())));
        };
        return approach(evidence, std::vector{&candidate}, predict, everything(evidence),
                        {plant::vanishing_setting(*candidate.effect)}, {.expected_sizes = 3.0});
    }
};

TEST(Approach, FromFarAway_ComesToTheOptimum) {
    const OfOneSize of;
    const Approach end =
        of.from_none(of.named("drive_gain"), [](double factor) { return 4000.0 * (factor - 1.1); });
    EXPECT_TRUE(end.is_near()) << end.median_square;
    EXPECT_NEAR(end.settings.front().values.front(), 1.1, 1e-3);
}

TEST(Approach, ToWhatNoSizePredicts_IsNotNear_AndSaysHowFarItIs) {
    const OfOneSize of;
    const Approach end = of.from_none(
        of.named("drive_gain"), [](double factor) { return std::hypot(20.0, 4000.0 * (factor - 1.1)); });
    EXPECT_FALSE(end.is_near());
    EXPECT_NEAR(end.median_square, 400.0, 4.0);
}

/// Some windows are beyond any prediction, as those in which friction lets the carriage go by chance.
TEST(Approach, FromAStartThatPredictsMostWindows_StaysThere) {
    const OfOneSize of;
    const Candidate& candidate = of.named("drive_gain");
    const std::vector<Window>& windows = of.evidence.windows();
    const Predict predict = [&](const Hypothesis& settings) {
        Errors errors(windows.back().end,
                      static_cast<float>(4000.0 * (settings.front().values.front() - 1.1)));
        for (std::size_t w = 0; w < windows.size(); w += 5)
            for (std::size_t k = windows[w].begin; k < windows[w].end; ++k) errors[k] += 20.0F;
        return errors;
    };
    const Hypothesis start{{candidate.effect, {1.1}}};
    const Approach end = approach(of.evidence, std::vector{&candidate}, predict, everything(of.evidence),
                                  start, {.expected_sizes = 3.0});
    EXPECT_TRUE(end.is_near()) << end.median_square;
    EXPECT_EQ(end.settings.front().values, start.front().values);
}

/// Counts make minima at every fourth step of the scale.
TEST(Approach, OfAScaleErrorBeyondACount_DoesNotEndAtTheNearestOne) {
    const OfOneSize of;
    const Candidate& scale = of.named("encoder_scale");
    const Approach end = of.from_none(scale, [&](double factor) {
        const double steps = (factor - 1.0) / scale.step_within_counts - 9.0;
        return 40.0 * std::sin(0.5 * std::numbers::pi * steps) + 5.0 * steps;
    });
    EXPECT_TRUE(end.is_near()) << end.median_square;
    EXPECT_NEAR((end.settings.front().values.front() - 1.0) / scale.step_within_counts, 9.0, 0.05);
}

}  // namespace

}  // namespace fidservo
