#include "gap/posterior.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

TEST(Posterior, ProbabilitiesGoWithTheExponentialOfTheLossSaved) {
    const auto shares = probabilities(std::vector{10.0, 10.0 + std::log(3.0) / values_per_window, 1e4});
    EXPECT_NEAR(shares[0], 0.75, 1e-12);
    EXPECT_NEAR(shares[1], 0.25, 1e-12);
    EXPECT_EQ(shares[2], 0.0);
    EXPECT_TRUE(probabilities({}).empty());
}

TEST(Posterior, ExplanationThatLeavesAGap_IsTrustedLess) {
    EXPECT_EQ(trust_in(1.0), 1.0);
    EXPECT_EQ(trust_in(1.1), 1.0);
    EXPECT_DOUBLE_EQ(trust_in(11.0), 0.2);
}

TEST(Posterior, NameIsNeverCertain) {
    EXPECT_DOUBLE_EQ(worth_of_names(1.0), 0.99);
    EXPECT_DOUBLE_EQ(worth_of_names(0.25), 0.99 / 64.0);
    EXPECT_EQ(worth_of_names(0.0), 0.0);
}

}  // namespace

}  // namespace fidservo
