// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/verdict/standing.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

const Support some{.weight = 0.8,
                   .left_floors = 1.5,
                   .without_floors = 10.0,
                   .gap_alone = 10.0,
                   .gap_after = 2.0,
                   .gap_left = 0.1,
                   .names = 2.0,
                   .halves_apart = 0.1};

TEST(Standing, FeaturesAreTheLogarithmsThatTheySay) {
    const Features features = features_of(some);
    EXPECT_NEAR(features[0], std::log(4.0), 1e-12);
    EXPECT_NEAR(features[1], -0.5 * std::log(3.0), 1e-12);
    EXPECT_NEAR(features[2], -0.5 * std::log(1.25), 1e-12);
    EXPECT_NEAR(features[3], std::log(10.0 / 1.5), 1e-12);
    EXPECT_NEAR(features[4], std::log(10.0), 1e-12);
    EXPECT_NEAR(features[5], std::log(2.0), 1e-12);
    EXPECT_NEAR(features[6], std::log(10.0), 1e-12);
    EXPECT_EQ(features[7], 1.0);
}

TEST(Standing, ProbabilityNeverFallsWithWhatSpeaksForAName) {
    const auto at = [](const std::function<void(Support&)>& changed) {
        Support support = some;
        changed(support);
        return calibrated_probability(support);
    };
    const double before = calibrated_probability(some);
    EXPECT_GT(at([](Support& support) { support.weight = 0.99; }), before);
    EXPECT_GE(at([](Support& support) { support.gap_after = 1.0; }), before);
    EXPECT_GE(at([](Support& support) { support.without_floors = 100.0; }), before);
    EXPECT_GE(at([](Support& support) { support.gap_left = 0.01; }), before);
    EXPECT_GE(at([](Support& support) { support.names = 8.0; }), before);
    EXPECT_GE(at([](Support& support) { support.halves_apart = 0.01; }), before);
    EXPECT_DOUBLE_EQ(at([](Support& support) { support.is_at_bound = true; }), 0.5 * before);
    EXPECT_LE(at([](Support& support) { support.leaves_something = true; }), before);
    EXPECT_LE(at([](Support& support) { support.leaves_dependence = true; }), before);
    EXPECT_DOUBLE_EQ(at([](Support& support) { support.is_contested = true; }), 0.5 * before);
}

TEST(Standing, CertaintyIsNeverWhole) {
    const Support best{.weight = 1.0,
                       .left_floors = 1.0,
                       .without_floors = 1e6,
                       .gap_alone = 1e6,
                       .gap_left = 0.0,
                       .names = 1.0,
                       .halves_apart = 0.0};
    EXPECT_LT(calibrated_probability(best), 1.0);
    EXPECT_GT(calibrated_probability(best), 0.9);
}

}  // namespace

}  // namespace fidservo
