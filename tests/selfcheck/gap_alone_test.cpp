// SPDX-License-Identifier: GPL-3.0-or-later
// The search for a size that makes a gap, on gaps in closed form.
#include "src/selfcheck/draw/gap_alone.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::selfcheck {
namespace {

constexpr GapAim aim{.low = 1.0, .high = 10.0, .target = 4.0};

TEST(SizeForGap, GapThatGoesWithSize_IsMetAtTheSecondTrial) {
    int trials = 0;
    const auto found = size_for_gap(
        [&](double size) {
            ++trials;
            return 50.0 * size;
        },
        {.start = 1.0, .largest = 10.0}, aim);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->size, 0.08, 1e-12);
    EXPECT_NEAR(found->gap_floors, 4.0, 1e-12);
    EXPECT_EQ(trials, 2);
}

TEST(SizeForGap, GapOfAnotherPower_ComesWithinAHalfOfTheTarget) {
    for (const double power : {0.3, 2.0, 4.0}) {
        const auto gap_of = [&](double size) { return 50.0 * std::pow(size, power); };
        const auto found = size_for_gap(gap_of, {.start = 1.0, .largest = 10.0}, aim);
        ASSERT_TRUE(found) << power;
        EXPECT_GE(found->gap_floors, aim.target / 1.5) << power;
        EXPECT_LE(found->gap_floors, aim.target * 1.5) << power;
        EXPECT_DOUBLE_EQ(found->gap_floors, gap_of(found->size)) << power;
    }
}

/// As for a carriage that moves for one size and is held for a smaller one.
TEST(SizeForGap, GapThatJumpsOverTheTarget_IsOneThatIsAllowed) {
    const auto found = size_for_gap([](double size) { return size < 0.3 ? 1.5 : 500.0; },
                                    {.start = 1.0, .largest = 10.0}, aim);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->gap_floors, 1.5);
    EXPECT_FALSE(size_for_gap([](double size) { return size < 0.3 ? 0.2 : 500.0; },
                              {.start = 1.0, .largest = 10.0}, aim));
}

TEST(SizeForGap, LargestSizeThatIsTooSmall_GivesNone) {
    EXPECT_FALSE(size_for_gap([](double size) { return 0.1 * size; }, {.start = 1.0, .largest = 5.0}, aim));
}

}  // namespace
}  // namespace fidservo::selfcheck
