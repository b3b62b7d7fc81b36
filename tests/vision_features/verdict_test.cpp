// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/verdict.h"

#include "core/random.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace fidservo::vision {
namespace {

TEST(Decide, GuardBand_IsTwoStandardUncertaintiesOnEitherSideOfTheLimit) {
    EXPECT_EQ(decide({103.0, 1.0}, 100.0, 5.0), Verdict::pass);
    EXPECT_EQ(decide({103.01, 1.0}, 100.0, 5.0), Verdict::not_decidable);
    EXPECT_EQ(decide({107.0, 1.0}, 100.0, 5.0), Verdict::not_decidable);
    EXPECT_EQ(decide({107.01, 1.0}, 100.0, 5.0), Verdict::fail);
    EXPECT_EQ(decide({92.9, 1.0}, 100.0, 5.0), Verdict::fail);
    EXPECT_EQ(decide({104.0, 1.0}, 100.0, 5.0, 1.0), Verdict::pass);
}

TEST(Decide, WithoutUncertainty_TheLimitItselfPasses) {
    EXPECT_EQ(decide({105.0, 0.0}, 100.0, 5.0), Verdict::pass);
    EXPECT_EQ(decide({105.0000001, 0.0}, 100.0, 5.0), Verdict::fail);
}

TEST(Decide, UncertaintyBeyondTheTolerance_NeverPasses) {
    EXPECT_EQ(decide({100.0, 3.0}, 100.0, 5.0), Verdict::not_decidable);
}

TEST(Decide, NotANumber_IsNotDecidable) {
    EXPECT_EQ(decide({std::numeric_limits<double>::quiet_NaN(), 1.0}, 100.0, 5.0), Verdict::not_decidable);
}

TEST(Decide, ValueOnTheLimit_IsWronglyDecidedNoMoreOftenThanStated) {
    constexpr std::uint64_t seed = 5;
    SCOPED_TRACE(seed);
    NoiseStream random(seed, "verdicts");
    int passed = 0;
    int failed = 0;
    constexpr int trials = 20000;
    for (int trial = 0; trial < trials; ++trial) {
        const Verdict verdict = decide({105.0 + random.normal(), 1.0}, 100.0, 5.0);
        passed += verdict == Verdict::pass;
        failed += verdict == Verdict::fail;
    }
    constexpr double stated = 0.02275;
    const double scatter = 4.0 * std::sqrt(stated / trials);
    EXPECT_NEAR(static_cast<double>(passed) / trials, stated, scatter);
    EXPECT_NEAR(static_cast<double>(failed) / trials, stated, scatter);
}

TEST(DecideAtLeast, IsOneSided) {
    EXPECT_EQ(decide_at_least({52.0, 1.0}, 50.0), Verdict::pass);
    EXPECT_EQ(decide_at_least({51.9, 1.0}, 50.0), Verdict::not_decidable);
    EXPECT_EQ(decide_at_least({47.9, 1.0}, 50.0), Verdict::fail);
    EXPECT_EQ(decide_at_least({500.0, 1.0}, 50.0), Verdict::pass);
}

TEST(NameOf, Verdicts_AreTheWordsOfTheResultFiles) {
    EXPECT_EQ(name_of(Verdict::pass), "pass");
    EXPECT_EQ(name_of(Verdict::fail), "fail");
    EXPECT_EQ(name_of(Verdict::not_decidable), "not_decidable");
}

}  // namespace
}  // namespace fidservo::vision
