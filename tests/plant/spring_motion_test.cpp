// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/spring_motion.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

/// By the midpoint rule in steps of 1 us; weakly, critically and strongly damped.
TEST(SpringMotion, OfAnyDamping_IsThatOfItsEquation) {
    constexpr double step_s = 1e-6, stiffness_per_s2 = 4e4;
    for (const double damping_per_s : {10.0, 400.0, 3000.0}) {
        const SpringMotion motion{800.0, stiffness_per_s2, damping_per_s, -3.0};
        double y = 0.0, v = -3.0;
        for (int k = 0; k < 20'000; ++k) {
            const double y_middle = y + 0.5 * step_s * v;
            const double v_middle = v + 0.5 * step_s * (800.0 - stiffness_per_s2 * y - damping_per_s * v);
            y += step_s * v_middle;
            v += step_s * (800.0 - stiffness_per_s2 * y_middle - damping_per_s * v_middle);
        }
        const auto [way_mm, mm_per_s] = motion.after(0.02);
        EXPECT_NEAR(way_mm, y, 1e-6) << damping_per_s;
        EXPECT_NEAR(mm_per_s, v, 1e-4) << damping_per_s;
    }
}

TEST(SpringMotion, StaysWithinItsRange_AndWithoutDampingReachesItsEnds) {
    for (const double damping_per_s : {0.0, 10.0, 3000.0}) {
        const SpringMotion motion{800.0, 4e4, damping_per_s, -3.0};
        const auto [low_mm, high_mm] = motion.range_mm();
        double least_mm = 0.0, most_mm = 0.0;
        for (int k = 0; k < 100'000; ++k) {
            const double way_mm = motion.after(1e-6 * k).first;
            least_mm = std::min(least_mm, way_mm);
            most_mm = std::max(most_mm, way_mm);
        }
        EXPECT_GT(least_mm, low_mm - 1e-12) << damping_per_s;
        EXPECT_LT(most_mm, high_mm + 1e-12) << damping_per_s;
        if (damping_per_s > 0.0) continue;
        EXPECT_NEAR(least_mm, low_mm, 1e-6);
        EXPECT_NEAR(most_mm, high_mm, 1e-6);
    }
}

}  // namespace
}  // namespace fidservo::plant
