// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/encoder_scale.h"

#include "calib/significance.h"
#include "core/failure.h"
#include "core/random.h"
#include "core/result.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

constexpr double resolution_mm = 0.05013, zero_mm = -3.217, noise_mm = 0.0002;

std::vector<EncoderStand> stands(std::uint64_t seed, int count) {
    NoiseStream noise(seed, "stands");
    std::vector<EncoderStand> all;
    for (int i = 0; i < count; ++i) {
        const double y_mm = 5.0 + 190.0 * noise.uniform();
        const double c = std::floor((y_mm - zero_mm) / resolution_mm + 0.5);
        all.push_back({c, y_mm + noise_mm * noise.normal(), noise_mm});
    }
    return all;
}

TEST(SlowEncoderScale, ErrorsOverSeeds_AreAsLargeAsTheirStandardErrorsSay) {
    constexpr int seeds = 200;
    double squares = 0.0, zero_squares = 0.0;
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto scale = fit_encoder_scale(stands(static_cast<std::uint64_t>(seed), 20));
        ASSERT_TRUE(scale);
        EXPECT_TRUE(scale->fits) << "seed " << seed;
        squares += std::pow((scale->resolution_mm - resolution_mm) / scale->resolution_std_mm, 2.0);
        zero_squares += std::pow((scale->zero_mm - zero_mm) / scale->zero_std_mm, 2.0);
    }
    const double high = chi_square_bound(seeds, 1e-4), low = seeds - (high - seeds);
    EXPECT_LT(squares, high);
    EXPECT_GT(squares, low);
    EXPECT_LT(zero_squares, high);
    EXPECT_GT(zero_squares, low);
}

TEST(SlowEncoderScale, StandsThatPileUpAtTheEdgesOfCounts_KeepTheirStandardErrors) {
    // A drive that stops as soon as its count is reached violates the uniform distribution within a count
    // that the likelihood assumes.
    constexpr int seeds = 100, way_counts = 3800;
    for (const int count : {10, 20, 40}) {
        double squares = 0.0;
        for (int seed = 1; seed <= seeds; ++seed) {
            NoiseStream noise(static_cast<std::uint64_t>(seed), "edges");
            std::vector<EncoderStand> all;
            for (int i = 0; i < count; ++i) {
                const double c = std::floor(way_counts * noise.uniform());
                const double in_count = noise.uniform() < 0.3   ? noise.uniform() - 0.5
                                        : noise.uniform() < 0.4 ? -0.499
                                                                : 0.499;
                all.push_back(
                    {c, zero_mm + resolution_mm * (c + in_count) + noise_mm * noise.normal(), noise_mm});
            }
            const auto scale = fit_encoder_scale(all);
            ASSERT_TRUE(scale);
            squares += std::pow((scale->resolution_mm - resolution_mm) / scale->resolution_std_mm, 2.0);
        }
        EXPECT_LT(squares, chi_square_bound(seeds, 1e-4)) << count << " stands";
        EXPECT_GT(squares, 0.5 * seeds);  // and not too wide by a factor of two
    }
}

TEST(EncoderScale, StandsByTheirCountsAlone_WouldBeWorse) {
    // Least squares of places over counts leaves resolution / sqrt(12 n) over the way's spread.
    constexpr int n = 40;
    const auto scale = fit_encoder_scale(stands(4, n));
    ASSERT_TRUE(scale);
    const double spread_mm = 190.0 / std::sqrt(12.0);
    const double least_squares_std = resolution_mm * resolution_mm / std::sqrt(12.0 * n) / spread_mm;
    EXPECT_LT(scale->resolution_std_mm, 0.6 * least_squares_std);
}

TEST(EncoderScale, NoisyPlaces_GiveTheLeastSquaresStandardError) {
    // Noise of many counts makes the likelihood normal: the textbook's slope and its standard error.
    NoiseStream noise(8, "noisy");
    constexpr double wide_mm = 0.3;
    std::vector<EncoderStand> all = stands(8, 60);
    for (EncoderStand& stand : all) {
        stand.carriage_mm += wide_mm * noise.normal();
        stand.std_mm = wide_mm;
    }
    double mean = 0.0, squares = 0.0;
    for (const EncoderStand& stand : all) mean += stand.carriage_mm / 60.0;
    for (const EncoderStand& stand : all) squares += std::pow(stand.carriage_mm - mean, 2.0);
    const auto scale = fit_encoder_scale(all);
    ASSERT_TRUE(scale);
    const double expected = resolution_mm *
                            std::sqrt(wide_mm * wide_mm + resolution_mm * resolution_mm / 12.0) /
                            std::sqrt(squares);
    EXPECT_NEAR(scale->resolution_std_mm / expected, 1.0, 0.05);
    EXPECT_NEAR(scale->resolution_mm, resolution_mm, 5.0 * expected);
}

TEST(EncoderScale, CountsThatAreNotEvenlySpaced_AreSaidNotToFit) {
    auto all = stands(3, 30);
    for (EncoderStand& stand : all) stand.count += std::round(2.0 * std::sin(stand.carriage_mm / 15.0));
    const auto scale = fit_encoder_scale(all);
    ASSERT_TRUE(scale);
    EXPECT_FALSE(scale->fits);
    EXPECT_GT(scale->excess_count, 0.5);
    EXPECT_NEAR(scale->resolution_mm, resolution_mm, 6.0 * scale->resolution_std_mm);
}

TEST(EncoderScale, ShortWayOrFewStands_AreRefused) {
    EXPECT_FALSE(fit_encoder_scale(stands(1, 3)));
    const std::vector<EncoderStand> near{{0, 0.0, 1e-4}, {5, 0.25, 1e-4}, {8, 0.4, 1e-4}, {10, 0.5, 1e-4}};
    const auto scale = fit_encoder_scale(near);
    ASSERT_FALSE(scale);
    EXPECT_EQ(scale.error().reason, Reason::not_identifiable);
}

}  // namespace
}  // namespace fidservo::calib
