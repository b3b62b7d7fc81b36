// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/tally/binomial.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::selfcheck {
namespace {

// Newcombe, Two-sided confidence intervals for the single proportion, Statistics in Medicine 17 (1998),
// table I, method 3.
TEST(WilsonInterval, PublishedExamples_AreMetToAllTheirDigits) {
    struct Example {
        Share share;
        double low, high;
    };
    for (const Example& example : {Example{{81, 263}, 0.2553, 0.3662}, Example{{15, 148}, 0.0624, 0.1605},
                                   Example{{0, 20}, 0.0000, 0.1611}, Example{{1, 29}, 0.0061, 0.1718}}) {
        const Interval interval = wilson_interval(example.share);
        EXPECT_NEAR(interval.low, example.low, 5e-5) << example.share.hits << " of " << example.share.of;
        EXPECT_NEAR(interval.high, example.high, 5e-5) << example.share.hits << " of " << example.share.of;
    }
}

TEST(WilsonInterval, AllHits_IsTheMirrorOfNone) {
    EXPECT_DOUBLE_EQ(wilson_interval({20, 20}).low, 1.0 - wilson_interval({0, 20}).high);
    EXPECT_DOUBLE_EQ(wilson_interval({20, 20}).high, 1.0);
}

TEST(Share, NoCases_SayNothing) {
    EXPECT_TRUE(std::isnan(Share{}.value()));
    EXPECT_EQ(wilson_interval({}).low, 0.0);
    EXPECT_EQ(wilson_interval({}).high, 1.0);
}

}  // namespace
}  // namespace fidservo::selfcheck
