#include "gap/noise_floor.h"

#include "core/random.h"
#include "tests/campaign.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

TEST(NoiseFloor, RoundedVarianceSpreadOverAStep_IsNoisePlusATwelfth) {
    constexpr int parts = 200;
    double sum = 0.0;
    for (int k = 0; k < parts; ++k) {
        const double mean = (k + 0.5) / parts;
        sum += rounded_variance(mean, 0.4);
    }
    // The mean variance about each mean's own rounded mean: less by what the rounded mean strays.
    double stray = 0.0;
    for (int k = 0; k < parts; ++k) {
        const auto about = testing::rounded_gaussian((k + 0.5) / parts, 0.4);
        stray += about.mean - rounded_variance((k + 0.5) / parts, 0.4);
    }
    EXPECT_NEAR((sum + stray) / parts, 0.4 * 0.4 + 1.0 / 12.0, 1e-6);
}

TEST(NoiseFloor, RestAtOnePlace_NoiseIsFoundWhereverInAStepItIs) {
    for (const double mean : {1024.0, 1024.3, 1024.5}) {
        NoiseStream noise(7, "rest");
        std::vector<double> reading;
        for (int k = 0; k < 40'000; ++k) reading.push_back(std::floor(mean + 0.4 * noise.normal() + 0.5));
        const auto found =
            noise_before_rounding(quiet_stretches(reading, std::vector<double>(reading.size(), 0.0)));
        ASSERT_TRUE(found);
        EXPECT_NEAR(*found, 0.4, 0.006) << mean << ", seed 7";  // four standard deviations
    }
}

TEST(NoiseFloor, CarriageThatNeverFlickers_HasNoNoise) {
    const auto found = noise_before_rounding(
        quiet_stretches(std::vector<double>(1000, 17.0), std::vector<double>(1000, 0.0)));
    ASSERT_TRUE(found);
    EXPECT_LT(*found, 1e-3);
}

}  // namespace

}  // namespace fidservo
