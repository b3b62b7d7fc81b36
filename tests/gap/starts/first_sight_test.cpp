// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/starts/first_sight.h"

#include "plant/effects/catalogue.h"
#include "tests/gap/equal_windows.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

std::vector<Promise> offsets_at_first_sight(const std::vector<Window>& windows, const Predict& predict) {
    const plant::Effect& offset = *plant::find_effect("hall_offset");
    const Candidate candidate{.effect = &offset,
                              .sizes = {0},
                              .shapes = {plant::typical_setting(offset).values},
                              .wave = {},
                              .patch = {},
                              .class_name = "hall_offset"};
    const Wanted all(windows.size(), 1);
    return at_first_sight(predict, windows, all, surroundings(predict, windows, all, {}, predict({}), {}),
                          candidate);
}

/// x: a Hall offset over the true one. A window that is at its floor without offset and with the true one,
/// but not between them, holds the other one back, which is 30 floors off: weighted by what they are at x = 0
/// both are least at x = 0.1.
TEST(FirstSight, WindowsThatHoldEachOtherBack_AreLeftBehindByGoingOn) {
    constexpr double true_V = -0.02;
    const std::vector<Window> windows = testing::equal_windows(80, 5);
    const Predict predict = [&](const Hypothesis& hypothesis) {
        const double x = hypothesis.empty() ? 0.0 : hypothesis.back().values[0] / true_V;
        Errors errors(400, static_cast<float>(4.0 * x * (1.0 - x)));
        std::fill(errors.begin() + 200, errors.end(), static_cast<float>(30.0 * (1.0 - x)));
        return errors;
    };
    const std::vector<Promise> starts = offsets_at_first_sight(windows, predict);
    ASSERT_FALSE(starts.empty());
    const double x = starts.front().start.back().values[0] / true_V;
    EXPECT_GT(x, 0.5);
    EXPECT_LT(x, 1.2);
}

/// A cold wire can only move in one direction: an offset of the other sign worsens windows that are at their
/// floors.
TEST(FirstSight, SizeThatDoesHarmToOneSide_IsLookedAtToTheOther) {
    const std::vector<Window> windows = testing::equal_windows(80, 5);
    for (const double true_V : {-0.02, 0.02}) {
        const Predict predict = [&](const Hypothesis& hypothesis) {
            const double x = hypothesis.empty() ? 0.0 : hypothesis.back().values[0] / true_V;
            Errors errors(400, static_cast<float>(100.0 * std::max(0.0, -x)));
            std::fill(errors.begin() + 200, errors.end(), static_cast<float>(30.0 * (1.0 - x)));
            return errors;
        };
        const std::vector<Promise> starts = offsets_at_first_sight(windows, predict);
        ASSERT_FALSE(starts.empty()) << true_V;
        EXPECT_NEAR(starts.front().start.back().values[0], true_V, 0.1 * std::abs(true_V));
    }
}

}  // namespace
}  // namespace fidservo
