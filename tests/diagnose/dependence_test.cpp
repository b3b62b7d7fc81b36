// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/report/dependence.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::diagnose {
namespace {

constexpr float left_x = 0.0f, right_x = 10.0f;

/// `count` samples in each of two bins; window 2 k + 1 lies `spread` above window 2 k.
std::vector<Sample> two_bins(int count, float left, float right, float spread) {
    std::vector<Sample> samples;
    for (const auto& [x, error] : {std::pair(left_x, left), std::pair(right_x, right)})
        for (std::uint32_t window = 0; window < 2; ++window)
            for (int i = 0; i < count; ++i)
                samples.push_back({x, error + spread * (static_cast<float>(window) - 0.5f), 0.0f, window});
    return samples;
}

TEST(Binned, MeansAndStandardErrors_AreThoseOfTheWindows) {
    const BinnedErrors errors = binned(two_bins(50, -2.0f, 4.0f, 0.5f), 2);
    ASSERT_EQ(errors.x, (std::vector<double>{2.5, 7.5}));
    EXPECT_DOUBLE_EQ(errors.before.mean[0], -2.0);
    EXPECT_DOUBLE_EQ(errors.before.mean[1], 4.0);
    // of two values a and b: |a - b| / 2, however many samples each stands for
    EXPECT_NEAR(errors.before.std_error[0], 0.25, 1e-12);
    EXPECT_NEAR(errors.before.std_error[1], 0.25, 1e-12);
    EXPECT_EQ(errors.after.mean[0], 0.0);
}

TEST(Binned, Share_IsThatOfTheMeansInTheSquares) {
    // squares: mean^2 + (spread / 2)^2 in each bin
    const BinnedErrors errors = binned(two_bins(50, -2.0f, 4.0f, 2.0f), 2);
    EXPECT_NEAR(errors.before.share, (4.0 + 16.0) / (5.0 + 17.0), 1e-12);
    EXPECT_EQ(errors.after.share, 0.0) << "no error, nothing to account for";
}

TEST(Binned, TooFewValues_GiveNoMean) {
    const BinnedErrors errors = binned(two_bins(5, -2.0f, 4.0f, 0.5f), 2);
    EXPECT_TRUE(std::isnan(errors.before.mean[0]));
    EXPECT_TRUE(std::isnan(errors.before.std_error[0]));
}

TEST(Binned, OneWindow_GivesNoStandardError) {
    std::vector<Sample> samples = two_bins(50, -2.0f, 4.0f, 0.5f);
    for (Sample& sample : samples) sample.window = 7;
    const BinnedErrors errors = binned(samples, 2);
    EXPECT_FALSE(std::isnan(errors.before.mean[0]));
    EXPECT_TRUE(std::isnan(errors.before.std_error[0]));
}

TEST(Binned, NothingThatVaries_GivesNoBins) {
    EXPECT_TRUE(binned({}, 2).x.empty());
    EXPECT_TRUE(binned({{1.0f, 0.0f, 0.0f, 0}, {1.0f, 2.0f, 0.0f, 0}}, 2).x.empty());
}

}  // namespace
}  // namespace fidservo::diagnose
