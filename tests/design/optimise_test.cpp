// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/design/optimise.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace fidservo::design {
namespace {

double hill(const std::vector<double>& at) {
    return 1.0 - (at[0] - 0.3) * (at[0] - 0.3) - 4.0 * (at[1] - 0.8) * (at[1] - 0.8);
}

TEST(Optimise, Hill_IsClimbed_AndTheSameWayEachTime) {
    const std::vector<double> start{0.9, 0.1};
    const Optimum first = maximised(hill, start, hill(start), {40, 120});
    EXPECT_NEAR(first.value, 1.0, 1e-3);
    const Optimum again = maximised(hill, start, hill(start), {40, 120});
    EXPECT_EQ(first.at, again.at);
}

TEST(Optimise, NothingBetter_LeavesTheStart) {
    const Optimum found = maximised([](const std::vector<double>&) { return 0.0; }, {0.5}, 1.0, {10, 10});
    EXPECT_EQ(found.at, std::vector<double>{0.5});
    EXPECT_EQ(found.value, 1.0);
}

TEST(Optimise, WhatTheFunctionThrows_IsThrownAgain) {
    int asked = 0;
    const auto throws_later = [&](const std::vector<double>&) -> double {
        if (++asked == 5) throw std::runtime_error("over");
        return static_cast<double>(asked);
    };
    EXPECT_THROW((void)maximised(throws_later, {0.5, 0.5}, 0.0, {20, 20}), std::runtime_error);
    EXPECT_EQ(asked, 5);
}

}  // namespace
}  // namespace fidservo::design
