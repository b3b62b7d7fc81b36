// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/hall/hall_curve.h"

#include "core/failure.h"
#include "core/random.h"
#include "core/result.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

constexpr HallParameters reference{.mid_V = 2.5,
                                   .span_V = 1.25,
                                   .centre_mm = 2.0,
                                   .half_range_mm = 2.0,
                                   .cubic = 0.12,
                                   .adc_bits = 12,
                                   .adc_range_V = 5.0,
                                   .noise_lsb = 0.4};

HallParameters different() {
    HallParameters hall = reference;
    hall.mid_V = 2.46;
    hall.span_V = 1.31;
    hall.centre_mm = 1.93;
    hall.cubic = 0.16;
    return hall;
}

/// Evenly spaced references, read as the rig's converter does; the references themselves have noise.
std::vector<HallSample> readings(const HallParameters& hall, double low_mm, double high_mm, int n,
                                 std::uint64_t seed, double reference_std_mm = 0.0) {
    NoiseStream adc(seed, "adc"), reference_noise(seed, "reference");
    std::vector<HallSample> samples;
    for (int i = 0; i < n; ++i) {
        const double x = low_mm + (high_mm - low_mm) * i / (n - 1);
        const double lsb = hall_voltage_V(hall, x) * 4096.0 / 5.0 + hall.noise_lsb * adc.normal();
        samples.push_back({x + reference_std_mm * reference_noise.normal(), std::floor(lsb + 0.5)});
    }
    return samples;
}

TEST(HallCurve, ExactVoltages_GiveBackTheCurve) {
    const HallParameters truth = different();
    std::vector<HallSample> samples;
    for (int i = 0; i <= 40; ++i) samples.push_back({0.1 * i, hall_voltage_V(truth, 0.1 * i) * 4096.0 / 5.0});
    const auto curve = fit_hall_curve(reference, samples, 0.0, 4.0);
    ASSERT_TRUE(curve) << curve.error().text;
    ASSERT_FALSE(curve->refused);
    EXPECT_NEAR(curve->hall.mid_V, truth.mid_V, 1e-9);
    EXPECT_NEAR(curve->hall.span_V, truth.span_V, 1e-9);
    EXPECT_NEAR(curve->hall.centre_mm, truth.centre_mm, 1e-9);
    EXPECT_NEAR(curve->hall.cubic, truth.cubic, 1e-9);
    EXPECT_LT(curve->residual_lsb, 1e-9);
}

TEST(HallCurve, ReferenceRig_ResolvesWhatThePaperSays) {
    const auto curve = fit_hall_curve(reference, readings(reference, 0.0, 4.0, 400, 1), 0.0, 4.0);
    ASSERT_TRUE(curve);
    EXPECT_NEAR(curve->mean_um_per_bit, 1.953, 0.002);
    EXPECT_LT(curve->finest_um_per_bit, curve->mean_um_per_bit);
    EXPECT_GT(curve->coarsest_um_per_bit, curve->mean_um_per_bit);
    EXPECT_NEAR(curve->residual_lsb, std::sqrt(0.16 + 1.0 / 12.0), 0.06);
}

TEST(HallCurve, Inverse_ReturnsTheReferences) {
    const HallParameters truth = different();
    const auto samples = readings(truth, 0.0, 4.0, 400, 2);
    const auto curve = fit_hall_curve(reference, samples, 0.0, 4.0);
    ASSERT_TRUE(curve);
    double squares = 0.0;
    for (const HallSample& sample : samples)
        squares +=
            std::pow(hall_position_mm(curve->hall, sample.adc * 5.0 / 4096.0) - sample.reference_mm, 2);
    // Noise and rounding of half an LSB, two micrometres each.
    EXPECT_LT(std::sqrt(squares / static_cast<double>(samples.size())), 0.0013);
}

TEST(HallCurve, StandardErrors_AreTrue) {
    const HallParameters truth = different();
    for (const double reference_std_mm : {0.0, 0.004}) {
        std::array<double, 4> squares{};
        constexpr int n = 60;
        for (std::uint64_t seed = 1; seed <= n; ++seed) {
            const auto curve =
                fit_hall_curve(reference, readings(truth, 0.0, 4.0, 300, seed, reference_std_mm), 0.0, 4.0);
            ASSERT_TRUE(curve && !curve->refused);
            squares[0] += std::pow((curve->hall.mid_V - truth.mid_V) / curve->mid_std_V, 2);
            squares[1] += std::pow((curve->hall.span_V - truth.span_V) / curve->span_std_V, 2);
            squares[2] += std::pow((curve->hall.centre_mm - truth.centre_mm) / curve->centre_std_mm, 2);
            squares[3] += std::pow((curve->hall.cubic - truth.cubic) / curve->cubic_std, 2);
        }
        // The 99.99 % interval of a chi-square distribution with 60 degrees of freedom, over 60: 0.44 to
        // 1.83.
        for (const double sum : squares) {
            EXPECT_GT(sum / n, 0.44) << "reference noise " << reference_std_mm;
            EXPECT_LT(sum / n, 1.83) << "reference noise " << reference_std_mm;
        }
    }
}

TEST(HallCurve, MiddleOfTheCurveOnly_GivesTheSlopeAndRefusesTheBend) {
    const auto curve = fit_hall_curve(reference, readings(reference, 1.8, 2.2, 200, 3), 0.0, 4.0);
    ASSERT_TRUE(curve) << curve.error().text;
    ASSERT_TRUE(curve->refused);
    EXPECT_EQ(curve->refused->reason, Reason::not_identifiable);
    EXPECT_EQ(curve->hall.centre_mm, reference.centre_mm);
    EXPECT_EQ(curve->hall.cubic, reference.cubic);
    EXPECT_NEAR(curve->hall.span_V, 1.25, 4.0 * curve->span_std_V);
    EXPECT_TRUE(std::isnan(curve->centre_std_mm));
}

TEST(HallCurve, HalfOfTheTravel_IsNotExtrapolated) {
    const auto curve = fit_hall_curve(reference, readings(reference, 0.0, 1.9, 60, 3), 0.0, 4.0);
    ASSERT_TRUE(curve) << curve.error().text;
    EXPECT_TRUE(curve->refused);
}

TEST(HallCurve, SaturatedReadings_AreLeftOutAndCounted) {
    auto samples = readings(reference, 0.0, 4.0, 200, 3);
    for (int i = 0; i < 7; ++i) samples.push_back({4.5 + 0.1 * i, 4095.0});
    const auto curve = fit_hall_curve(reference, samples, 0.0, 4.0);
    ASSERT_TRUE(curve && !curve->refused);
    EXPECT_EQ(curve->saturated, 7U);
    EXPECT_NEAR(curve->hall.cubic, 0.12, 4.0 * curve->cubic_std);
}

TEST(HallCurve, UselessData_AreRefused) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(fit_hall_curve(reference, {}, 0.0, 4.0));
    const std::vector<HallSample> still(100, {1.0, 2000.0}), holes(100, {nan, nan}),
        huge(100, {1e200, 1e200});
    EXPECT_FALSE(fit_hall_curve(reference, still, 0.0, 4.0));
    EXPECT_FALSE(fit_hall_curve(reference, holes, 0.0, 4.0));
    EXPECT_FALSE(fit_hall_curve(reference, huge, 0.0, 4.0));
    std::vector<HallSample> falling = readings(reference, 0.0, 4.0, 100, 1);
    for (HallSample& sample : falling) sample.reference_mm = 4.0 - sample.reference_mm;
    EXPECT_FALSE(fit_hall_curve(reference, falling, 0.0, 4.0));
}

TEST(HallCurve, RandomData_NeverBreakIt) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        NoiseStream draw(seed, "robustness");
        std::vector<HallSample> samples(static_cast<std::size_t>(80.0 * draw.uniform()));
        for (HallSample& sample : samples)
            sample = {8.0 * draw.uniform() - 2.0, std::floor(5000.0 * draw.uniform() - 400.0)};
        const auto curve = fit_hall_curve(reference, samples, 0.0, 4.0);
        if (!curve) continue;
        EXPECT_TRUE(std::isfinite(curve->hall.span_V) && std::isfinite(curve->residual_lsb));
    }
}

}  // namespace
}  // namespace fidservo::calib
