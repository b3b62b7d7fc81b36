// SPDX-License-Identifier: GPL-3.0-or-later
// Likelihoods of what is not named, against closed forms.
#include "src/fleet/report/statistics/censored.h"

#include "src/fleet/report/statistics/change_points.h"
#include "src/fleet/report/statistics/change_scan.h"
#include "src/fleet/report/statistics/limited_scan.h"
#include "src/fleet/report/statistics/population.h"
#include "src/fleet/report/statistics/within_scatter.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::fleet {
namespace {

double below(double z) {
    return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

double within(double limit, double mean, double variance) {
    return below((limit - mean) / std::sqrt(variance)) - below((-limit - mean) / std::sqrt(variance));
}

double normal_density(double distance, double variance) {
    return std::exp(-0.5 * distance * distance / variance) / std::sqrt(2.0 * std::numbers::pi * variance);
}

TEST(Censored_, ProbabilityWithin_IsTheDifferenceOfTwoTails) {
    for (const double mean : {-2.0, -0.3, 0.0, 0.5, 1.7})
        EXPECT_NEAR(std::exp(log_within(0.5, mean, 0.4)), within(0.5, mean, 0.16), 1e-14) << mean;
}

TEST(Censored_, ProbabilityWithinFarFromTheMean_HasItsLogarithm) {
    // Phi(-z) lies between phi(z)/z (1 - 1/z^2) and phi(z)/z.
    const double z = 60.0, log_upper = -0.5 * z * z - std::log(z * std::sqrt(2.0 * std::numbers::pi));
    EXPECT_LT(log_within(1.0, 7.0, 0.1), log_upper);
    EXPECT_GT(log_within(1.0, 7.0, 0.1), log_upper + std::log(1.0 - 1.0 / (z * z)) - 1e-9);
    EXPECT_EQ(log_within(1.0, 7.0, 0.1), log_within(1.0, -7.0, 0.1));
}

TEST(Censored_, MomentsWithin_AreThoseOfTheTruncatedNormalLaw) {
    const Moments about_zero = moments_within(1.0, 0.0, 1.0);
    EXPECT_NEAR(about_zero.mean, 0.0, 1e-15);
    EXPECT_NEAR(about_zero.variance, 1.0 - 2.0 * normal_density(1.0, 1.0) / within(1.0, 0.0, 1.0), 1e-14);
    const Moments wide = moments_within(0.5, 0.0, 1e3);
    EXPECT_NEAR(wide.variance, 0.25 / 3.0, 1e-6) << "uniform";
}

TEST(Censored_, OneThatIsNotNamed_SpreadsTheLevelOverItsLimitAndError) {
    const std::array points{Point{0.0, 0.0, 0.2, 0.5}};
    const Nodes level = over_level(points, 0.0);
    EXPECT_NEAR(level.log_integral(), std::log(2.0 * 0.5), 1e-12);
    EXPECT_NEAR(level.moments().mean, 0.0, 1e-12);
    EXPECT_NEAR(level.moments().variance, 0.25 / 3.0 + 0.04, 1e-12);
    EXPECT_NEAR(as_normal(Level{0.0, 0.2, 0.5}).std, std::sqrt(0.25 / 3.0 + 0.04), 1e-15);
}

TEST(Censored_, AllNamed_IntegralIsTheRestrictedLikelihood) {
    const std::array points{Point{0.0, 1.0, 0.3}, Point{1.0, 1.4, 0.1}, Point{2.0, 0.7, 0.2}};
    double weights = 0.0, values = 0.0, log_densities = 0.0;
    for (const Point& point : points) {
        weights += 1.0 / (point.std * point.std);
        values += point.value / (point.std * point.std);
    }
    for (const Point& point : points)
        log_densities += std::log(normal_density(point.value - values / weights, point.std * point.std));
    const Nodes level = over_level(points, 0.0);
    EXPECT_NEAR(level.log_integral(), log_densities + 0.5 * std::log(2.0 * std::numbers::pi / weights),
                1e-11);
    EXPECT_NEAR(level.moments().mean, values / weights, 1e-11);
    EXPECT_NEAR(level.moments().variance, 1.0 / weights, 1e-11);
}

TEST(Censored_, OneNamedAndOneNot_IntegralIsInClosedForm) {
    const std::array points{Point{0.0, 0.9, 0.3}, Point{1.0, 0.0, 0.2, 0.5}};
    const double extra = 0.05;
    EXPECT_NEAR(over_level(points, extra).log_integral(),
                std::log(within(0.5, 0.9, 0.09 + 0.04 + 2.0 * extra)), 1e-11);
}

TEST(Censored_, StepAfterOneThatIsNotNamed_RatioIsInClosedForm) {
    constexpr double value = 2.0, limit = 0.5, sigma = 0.15;
    const std::array points{Point{0.0, 0.0, 0.1, limit}, Point{1.0, value, 0.1}};
    // So many degrees of freedom that the scale is 1.
    const ChangeScan found = scan_with_limits(points, {sigma, 1e5});
    const double errors = 2.0 * (0.01 + sigma * sigma);
    double changed = 0.0, drifted = 0.0;
    for (const double law : {1.0, 4.0, 16.0}) changed += within(limit, value, errors + law * law) / 3.0;
    for (const double law : {0.25, 1.0, 4.0}) drifted += within(limit, value, errors + law * law) / 3.0;
    const double unchanged = within(limit, value, errors);
    EXPECT_NEAR(found.log_weight(ChangeKind::step), std::log(changed / unchanged), 1e-6);
    EXPECT_NEAR(found.log_weight(ChangeKind::trend), std::log(drifted / unchanged), 1e-6);
}

TEST(Censored_, StepToWhatIsNotNamed_RatioIsInClosedForm) {
    constexpr double value = 2.0, limit = 0.5;
    const std::array points{Point{0.0, value, 0.1}, Point{1.0, 0.0, 0.1, limit}};
    double changed = 0.0;
    for (const double law : {1.0, 4.0, 16.0}) changed += within(limit, value, 0.02 + law * law) / 3.0;
    EXPECT_NEAR(scan_with_limits(points, {0.0, 1e5}).log_weight(ChangeKind::step),
                std::log(changed / within(limit, value, 0.02)), 1e-6);
}

TEST(Censored_, AllNamed_ScanByNodesIsTheOneInClosedForm) {
    std::vector<Point> points;
    points.reserve(6);
    for (int week = 0; week < 6; ++week)
        points.push_back({static_cast<double>(week), week < 3 ? 1.0 + 0.1 * week : 2.2 - 0.1 * week, 0.2});
    const Scatter scatter{0.1, 1e5};
    const ChangeScan by_nodes = scan_with_limits(points, scatter),
                     closed = scan_as_normal(points, scatter, {});
    for (const ChangeKind kind : {ChangeKind::step, ChangeKind::trend})
        EXPECT_NEAR(by_nodes.log_weight(kind), closed.log_weight(kind), 1e-3);
}

TEST(Censored_, UnitsOfWhichHalfAreNotNamed_PopulationIsFound) {
    constexpr unsigned seed = 12;
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    std::vector<Level> units;
    for (int unit = 0; unit < 4000; ++unit) {
        const double value = 0.2 + std::hypot(0.4, 0.1) * normal(generator);
        units.push_back(std::abs(value) < 0.458 ? Level{0.0, 0.1, 0.458} : Level{value, 0.1});
    }
    const Population population = population_of(units);
    EXPECT_NEAR(population.mean, 0.2, 0.03) << "seed " << seed;
    EXPECT_NEAR(population.spread, 0.4, 0.03) << "seed " << seed;
    const Level unnamed = pooled({0.0, 0.1, 0.458}, population);
    EXPECT_GT(unnamed.value, 0.0);
    EXPECT_LT(unnamed.value, population.mean);
}

TEST(Censored_, UnitsNamedNowAndThen_ScatterIsFound) {
    constexpr unsigned seed = 13;
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    std::vector<WithinScatter::Stretches> units;
    for (int unit = 0; unit < 200; ++unit) {
        const double level = 0.6 * normal(generator);
        std::vector<Point>& points = units.emplace_back().emplace_back();
        for (int week = 0; week < 10; ++week) {
            const double value = level + std::hypot(0.1, 0.15) * normal(generator);
            points.push_back({static_cast<double>(week), 0.0, 0.1, 0.458});
            if (std::abs(value) >= 0.458) points.back() = {static_cast<double>(week), value, 0.1};
        }
    }
    const WithinScatter scatter(units);
    const Scatter common = common_scatter({&scatter, 1}, std::vector<std::optional<std::size_t>>(1));
    EXPECT_NEAR(scatter.of_all(common).std, 0.15, 0.03) << "seed " << seed;
}

TEST(Censored_, LevelOfAUnitNamedNowAndThen_IsNotThatOfItsNames) {
    // Seen at 0.5 once, and once not: the level is below what is seen as often as above.
    const std::array points{Point{0.0, 0.5, 0.1}, Point{1.0, 0.0, 0.1, 0.458}};
    const Level level = level_now(points, {0.15, 1e5}, {});
    EXPECT_LT(level.value, 0.458);
    EXPECT_GT(level.value, 0.2);
    EXPECT_TRUE(level.named());
}

}  // namespace
}  // namespace fidservo::fleet
