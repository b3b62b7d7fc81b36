// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/tally/reliability.h"

#include "core/random.h"

#include <gtest/gtest.h>

namespace fidservo::selfcheck {
namespace {

TEST(Reliability, OneBinByHand_IsTheDifferenceOfMeans) {
    const Reliability found = reliability_of({{0.9, true}, {0.7, false}, {0.8, true}, {0.6, true}});
    ASSERT_EQ(found.bins.size(), 1u);
    EXPECT_DOUBLE_EQ(found.bins.front().mean_probability, 0.75);
    EXPECT_DOUBLE_EQ(found.bins.front().share_true, 0.75);
    EXPECT_NEAR(found.expected_error, 0.0, 1e-15);
    EXPECT_NEAR(found.brier, (0.01 + 0.49 + 0.04 + 0.16) / 4.0, 1e-15);
}

TEST(Reliability, TwoBinsByHand_AreWeighedByTheirCases) {
    const Reliability found = reliability_of({{0.9, false}, {0.1, false}, {0.2, true}, {0.8, true}}, 2, 1);
    ASSERT_EQ(found.bins.size(), 2u);
    EXPECT_DOUBLE_EQ(found.bins[0].mean_probability, 0.15);
    EXPECT_DOUBLE_EQ(found.bins[1].share_true, 0.5);
    EXPECT_NEAR(found.expected_error, 0.5 * 0.35 + 0.5 * 0.35, 1e-15);
}

TEST(Reliability, FewClaims_AreInFewBinsAndNoneIsLeftOut) {
    EXPECT_EQ(reliability_of({{0.5, true}, {0.6, true}, {0.7, false}}).bins.size(), 1u);
    const Reliability found = reliability_of(std::vector<Claim>(67, {0.5, true}));
    ASSERT_EQ(found.bins.size(), 3u);
    EXPECT_EQ(found.bins[0].claims + found.bins[1].claims + found.bins[2].claims, 67u);
    EXPECT_TRUE(reliability_of({}).bins.empty());
}

TEST(Reliability, DrawnAsClaimed_HasNoErrorAndOverconfidenceHasItsOwn) {
    NoiseStream draw(5, "claims");
    std::vector<Claim> honest, bold;
    for (int k = 0; k < 200'000; ++k) {
        const double p = 0.5 + 0.5 * draw.uniform();
        const bool came_true = draw.uniform() < p;
        honest.push_back({p, came_true});
        bold.push_back({1.0, came_true});
    }
    EXPECT_LE(reliability_of(honest).expected_error, 0.01);
    EXPECT_NEAR(reliability_of(bold).expected_error, 0.25, 0.01);
    EXPECT_NEAR(reliability_of(honest).brier, 1.0 / 6.0, 0.005);  // mean of p (1 - p)
}

}  // namespace
}  // namespace fidservo::selfcheck
