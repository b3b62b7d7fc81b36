// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/drift.h"

#include "calib/significance.h"
#include "core/random.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

TEST(Significance, NormalBound_IsTheTablesOne) {
    EXPECT_NEAR(normal_bound(0.5), 0.0, 1e-12);
    EXPECT_NEAR(normal_bound(0.025), 1.959963985, 1e-8);
    EXPECT_NEAR(normal_bound(0.0005), 3.290526731, 1e-8);
}

TEST(Significance, ChiSquareBound_IsTheTablesToAPerCent) {
    EXPECT_NEAR(chi_square_bound(10.0, 0.05), 18.307, 0.02);
    EXPECT_NEAR(chi_square_bound(10.0, 0.001), 29.588, 0.01 * 29.588);
    EXPECT_NEAR(chi_square_bound(100.0, 0.01), 135.807, 0.05);
}

TEST(Significance, MeanSquareRatioBound_IsNearTheTablesOne) {
    EXPECT_NEAR(mean_square_ratio_bound(8.0, 16.0, 0.01), 3.890, 0.03 * 3.890);
    EXPECT_NEAR(mean_square_ratio_bound(1.0, 20.0, 0.005), 9.944, 0.03 * 9.944);
}

TEST(Drift, ManyHealthyLists_RaiseOneFalseAlarmInAHundredAtMost) {
    NoiseStream noise(17, "healthy");
    constexpr int lists = 5000, quantities = 12;
    int alarms = 0;
    for (int list = 0; list < lists; ++list) {
        std::vector<Expectation> all;
        for (int k = 0; k < quantities; ++k)
            all.push_back({"quantity", "mm", 5.0, 5.0 + 0.01 * noise.normal(), 0.01, 0.0});
        bool any = false;
        for (const DriftVerdict& verdict : judge_drift(all)) any = any || verdict.drifted;
        alarms += any ? 1 : 0;
    }
    EXPECT_LT(alarms, 0.01 * lists + 3.0 * std::sqrt(0.01 * lists));
    EXPECT_GT(alarms, 0.01 * lists - 4.0 * std::sqrt(0.01 * lists));  // and not fewer alarms than stated
}

TEST(Drift, DifferencesThatDoNotMatter_AreNone) {
    const std::vector<Expectation> all{{"a", "mm", 0.0, 0.5, 1e-6, 1.0}, {"b", "mm", 0.0, 1.5, 1e-6, 1.0}};
    const auto verdicts = judge_drift(all);
    EXPECT_FALSE(verdicts[0].drifted);
    EXPECT_TRUE(verdicts[1].drifted);
}

TEST(Drift, WhatIsNoNumber_IsNotHealthy) {
    const std::vector<Expectation> all{{"a", "mm", 0.0, std::numeric_limits<double>::quiet_NaN(), 1e-6, 1.0}};
    EXPECT_TRUE(judge_drift(all)[0].drifted);
}

}  // namespace
}  // namespace fidservo::calib
