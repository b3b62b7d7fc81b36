// SPDX-License-Identifier: GPL-3.0-or-later
// Piecewise linear basis functions.
#include "gap/balance/hat_functions.h"

#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

TEST(HatFunctions, OneAtTheirKnot_ZeroAtAllOthers) {
    const std::vector<double> knots{-1.0, 0.5, 4.0};
    for (std::size_t k = 0; k < knots.size(); ++k)
        for (std::size_t other = 0; other < knots.size(); ++other)
            EXPECT_DOUBLE_EQ(hat(knots, k, knots[other]), k == other ? 1.0 : 0.0);
}

TEST(HatFunctions, AddUpToOneEverywhere_AlsoBeyondTheOuterKnots) {
    const std::vector<double> knots{-1.0, 0.5, 4.0, 4.5};
    for (double x = -3.0; x < 7.0; x += 0.1) {
        double sum = 0.0;
        for (std::size_t k = 0; k < knots.size(); ++k) sum += hat(knots, k, x);
        EXPECT_NEAR(sum, 1.0, 1e-12) << x;
    }
}

TEST(HatFunctions, ALinearCombinationInterpolatesLinearly) {
    const std::vector<double> knots{0.0, 1.0, 3.0};
    const auto line = [](double x) { return 2.0 - 0.7 * x; };
    for (double x = 0.0; x <= 3.0; x += 0.25) {
        double sum = 0.0;
        for (std::size_t k = 0; k < knots.size(); ++k) sum += line(knots[k]) * hat(knots, k, x);
        EXPECT_NEAR(sum, line(x), 1e-12) << x;
    }
}

TEST(HatFunctions, KnotsShareTheValuesEvenly_AndNoneOccursTwice) {
    std::vector<float> values;
    for (int k = 0; k <= 100; ++k) values.push_back(static_cast<float>(k * k));
    EXPECT_EQ(knots_by_share(values, 5), (std::vector<double>{0.0, 625.0, 2500.0, 5625.0, 10000.0}));
    EXPECT_EQ(knots_by_share({3.0F, 3.0F, 3.0F, 7.0F}, 4), (std::vector<double>{3.0, 7.0}));
    EXPECT_TRUE(knots_by_share({}, 4).empty());
}

}  // namespace
}  // namespace fidservo
