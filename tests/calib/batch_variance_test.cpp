// SPDX-License-Identifier: GPL-3.0-or-later
// Whether 95 % intervals contain the truth in 95 % of campaigns.
#include "calib/batch_variance.h"

#include "calib/heterogeneity.h"
#include "calib/significance.h"
#include "calib/tails.h"
#include "core/random.h"

#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

constexpr int campaigns = 1000;

/// The number of hits must be in the interval that contains it with 99.9 % if each has probability 0.95. A
/// lower `least_share` states the limit of what two or three recordings can show.
void expect_95_percent(const std::string& name, int hits, bool may_be_wider = false,
                       double least_share = 0.95) {
    const double share = static_cast<double>(hits) / campaigns;
    const double reach = normal_bound(0.0005) * std::sqrt(0.95 * 0.05 / campaigns);
    fmt::print("coverage of 95 % intervals | {} | {:.1f} % of {}\n", name, 100.0 * share, campaigns);
    EXPECT_GT(share, least_share - reach) << name;
    if (!may_be_wider) {
        EXPECT_LT(share, 0.95 + reach) << name;
    }
}

/// The mean of a first-order autoregressive series of unit variance about `level`, as an estimate.
struct Mean {
    double value;
    BatchVariance variance;
};

Mean mean_of_series(NoiseStream& noise, double level, double memory, std::size_t n) {
    std::vector<double> series(n);
    double state = noise.normal(), sum = 0.0;
    for (double& value : series) {
        value = level + state;
        sum += value;
        state = memory * state + std::sqrt(1.0 - memory * memory) * noise.normal();
    }
    const auto count = static_cast<double>(n), mean = sum / count;
    for (double& value : series) value = (value - mean) / count;
    return {mean, batch_variance({&series, 1}, 1)};
}

bool holds(double error, double variance, double freedom) {
    return std::abs(error) <= student_bound(freedom, 0.05) * std::sqrt(variance);
}

TEST(BatchVariance, Intervals_CoverUnderWhiteAndCorrelatedErrors) {
    for (const double memory : {0.0, 0.5, 0.9, 0.97}) {
        int hits = 0;
        NoiseStream noise(1, "batches");
        for (int i = 0; i < campaigns; ++i) {
            const Mean mean = mean_of_series(noise, 0.0, memory, 2000);
            hits += holds(mean.value, mean.variance.variance, mean.variance.freedom);
        }
        expect_95_percent(fmt::format("2000 errors, correlation {} from one to the next", memory), hits);
    }
}

TEST(BatchVariance, LeastSquaresError_WouldNotCover) {
    int hits = 0;
    NoiseStream noise(1, "least squares");
    for (int i = 0; i < campaigns; ++i)
        hits += holds(mean_of_series(noise, 0.0, 0.9, 2000).value, 1.0 / 2000.0, 1999.0);
    EXPECT_LT(hits, campaigns / 2);
}

/// Recordings of which each has a value of its own, `between` about a common mean.
int hits_over_recordings(std::size_t recordings, double between, double memory) {
    constexpr std::size_t n = 400;
    int hits = 0;
    NoiseStream noise(2, "recordings");
    for (int i = 0; i < campaigns; ++i) {
        std::vector<RecordingEstimate> own;
        double weights = 0.0, joint = 0.0;
        VarianceSum sum;
        for (std::size_t j = 0; j < recordings; ++j) {
            const Mean mean = mean_of_series(noise, between * noise.normal(), memory, n);
            own.push_back({mean.value, std::sqrt(mean.variance.variance), mean.variance.freedom});
            joint += mean.value / mean.variance.variance;
            weights += 1.0 / mean.variance.variance;
        }
        double freedom = 0.0;
        for (const RecordingEstimate& one : own) freedom += one.freedom;
        sum.add(1.0 / weights, freedom);
        const Heterogeneity scatter = heterogeneity(own);
        sum.add(scatter.added_variance, scatter.added_freedom);
        hits += holds(joint / weights, sum.variance, sum.freedom);
    }
    return hits;
}

TEST(SlowHeterogeneity, IntervalsOverRecordings_CoverTheMeanOfTheirValues) {
    for (const std::size_t recordings : {2UL, 3UL, 6UL, 12UL}) {
        for (const double between : {0.2, 0.5, 2.0}) {
            // Two or three recordings that agree by chance do not show that others would differ.
            const double least_share = recordings <= 3 && between < 2.0 ? 0.8 : 0.95;
            expect_95_percent(fmt::format("{} recordings that differ by {:.0f} standard errors of one",
                                          recordings, between * 20.0),
                              hits_over_recordings(recordings, between, 0.0), true, least_share);
        }
        expect_95_percent(fmt::format("{} recordings that agree", recordings),
                          hits_over_recordings(recordings, 0.0, 0.5), true);
    }
}

TEST(Heterogeneity, EqualRecordings_AreCalledContradictoryAsOftenAsTheLevelSays) {
    constexpr int trials = 4000;
    constexpr double level = 0.05;
    for (const std::size_t recordings : {2UL, 5UL}) {
        NoiseStream noise(3, "level");
        int called = 0;
        for (int i = 0; i < trials; ++i) {
            std::vector<RecordingEstimate> own;
            for (std::size_t j = 0; j < recordings; ++j) {
                const Mean mean = mean_of_series(noise, 0.0, 0.0, 10 + 10 * j);
                own.push_back({mean.value, std::sqrt(mean.variance.variance), mean.variance.freedom});
            }
            called += heterogeneity(own).probability < level;
        }
        fmt::print("false contradictions of {} equal recordings | {:.1f} %, level 5 %\n", recordings,
                   100.0 * called / trials);
        EXPECT_LT(called, trials * level * 1.5);
    }
}

TEST(Heterogeneity, TwoRecordings_AreStudentsTestOfTwoMeans) {
    const Heterogeneity found =
        heterogeneity(std::vector<RecordingEstimate>{{80.7, 1.1, 20.0}, {61.9, 0.7, 60.0}});
    EXPECT_NEAR(found.apart, 18.8 / std::hypot(1.1, 0.7), 1e-9);
    EXPECT_NEAR(found.q, found.apart * found.apart, 1e-9);
    EXPECT_EQ(found.low, 1U);
    EXPECT_EQ(found.high, 0U);
    const double freedom =
        std::pow(1.1 * 1.1 + 0.7 * 0.7, 2) / (std::pow(1.1, 4) / 20.0 + std::pow(0.7, 4) / 60.0);
    EXPECT_NEAR(found.probability / mean_square_ratio_tail(found.q, 1.0, freedom), 1.0, 1e-6);
}

TEST(Tails, KnownQuantiles_AreMet) {
    EXPECT_NEAR(student_bound(1.0, 0.05), 12.7062, 1e-3);
    EXPECT_NEAR(student_bound(4.0, 0.05), 2.77645, 1e-4);
    EXPECT_NEAR(student_bound(INFINITY, 0.05), 1.95996, 1e-4);
    EXPECT_NEAR(mean_square_ratio_tail(4.1028, 2.0, 10.0), 0.05, 1e-5);
    EXPECT_NEAR(mean_square_ratio_tail(11.3449 / 3.0, 3.0, INFINITY), 0.01, 1e-5);
}

}  // namespace
}  // namespace fidservo::calib
