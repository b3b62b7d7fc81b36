// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/verdict/model_weights.h"

#include "tests/gap/simulated_campaign.h"

#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using gap::model_weights;

using Densities = std::vector<std::vector<double>>;

TEST(ModelWeights, OfOneRecording_GoWithTheDensities) {
    const std::vector<double> weights = model_weights(Densities{{-3.0}, {-3.0 - std::log(3.0)}, {-1e4}});
    EXPECT_NEAR(weights[0], 0.75, 1e-12);
    EXPECT_NEAR(weights[1], 0.25, 1e-12);
    EXPECT_EQ(weights[2], 0.0);
    EXPECT_TRUE(model_weights(Densities{}).empty());
}

TEST(ModelWeights, WhatEveryRecordingSays_IsSure) {
    const std::vector<double> weights = model_weights(Densities{{0, 0, 0, 0}, {-4, -4, -4, -4}});
    EXPECT_NEAR(weights[0], 1.0 / (1.0 + std::exp(-16.0)), 1e-12);
}

TEST(ModelWeights, WhatOneRecordingSaysAlone_IsNot) {
    const Densities one_says{{0, 0, 0, 0}, {-16, 0, 0, 0}};
    const std::vector<double> weights = model_weights(one_says);
    EXPECT_LT(weights[0], 0.99);
    EXPECT_GT(weights[0], 0.7);
    const std::vector<double> torn = model_weights(Densities{{0, 0}, {-8, 8}});
    EXPECT_NEAR(torn[0], 0.5, 0.1);
    EXPECT_NEAR(torn[0] + torn[1], 1.0, 1e-12);
}

TEST(ModelWeights, OfTwoExplanations_GoWithWhatTheyPredict) {
    const gap::Evidence evidence = testing::campaign({}, {"macro-square"});
    const std::size_t windows = evidence.windows().size();
    const std::vector<double> floor(windows, 1.0), off(windows, 100.0), unknown(windows, std::nan(""));
    EXPECT_NEAR(gap::weight_of_first(evidence, floor, floor), 0.5, 1e-9);
    EXPECT_GT(gap::weight_of_first(evidence, floor, off), 0.99);
    EXPECT_LT(gap::weight_of_first(evidence, off, floor), 0.01);
    EXPECT_NEAR(gap::weight_of_first(evidence, floor, unknown), 0.5, 1e-9);
}

}  // namespace

}  // namespace fidservo
