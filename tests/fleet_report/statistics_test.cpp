// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/statistics/attribution.h"
#include "src/fleet/report/statistics/change_points.h"
#include "src/fleet/report/statistics/population.h"
#include "src/fleet/report/statistics/within_scatter.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace fidservo::fleet {
namespace {

std::vector<Point> weekly(const std::vector<double>& values, double std) {
    std::vector<Point> points;
    for (std::size_t week = 0; week < values.size(); ++week)
        points.push_back({static_cast<double>(week), values[week], std});
    return points;
}

/// Units that have one level each.
std::vector<WithinScatter::Stretches> uncut(const std::vector<std::vector<Point>>& units) {
    std::vector<WithinScatter::Stretches> all;
    all.reserve(units.size());
    for (const std::vector<Point>& unit : units) all.push_back({unit});
    return all;
}

TEST(Population_, EqualErrors_SpreadIsTheSampleVarianceLessTheErrors) {
    const std::vector<Level> units{{1.0, 0.5}, {2.0, 0.5}, {4.0, 0.5}, {5.0, 0.5}};
    const Population population = population_of(units);
    EXPECT_NEAR(population.mean, 3.0, 1e-9);
    EXPECT_NEAR(population.spread, std::sqrt(10.0 / 3.0 - 0.25), 1e-4);
}

TEST(Population_, UnitsAsAlikeAsTheirErrors_HaveNoSpread) {
    const std::vector<Level> units{{1.0, 1.0}, {1.5, 1.0}, {0.5, 1.0}};
    EXPECT_EQ(population_of(units).spread, 0.0);
}

TEST(Population_, UnitOfFewData_IsDrawnToTheFleet) {
    const Population population{.mean = 2.0, .mean_std = 0.0, .spread = 1.0};
    const Level unsure = pooled({5.0, 2.0}, population), sure = pooled({5.0, 0.1}, population);
    EXPECT_NEAR(unsure.value, 2.0 + 3.0 * 1.0 / 5.0, 1e-12);
    EXPECT_NEAR(unsure.std, std::sqrt(0.8), 1e-12);
    EXPECT_NEAR(sure.value, 2.0 + 3.0 / 1.01, 1e-12);
}

TEST(WithinScatter_, ManyUnits_FindsWhatTheyScatterBy) {
    constexpr unsigned seed = 4;
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    std::vector<std::vector<Point>> units;
    for (int unit = 0; unit < 60; ++unit) {
        std::vector<double> values(10);
        const double level = 5.0 * normal(generator);
        for (double& value : values) value = level + std::hypot(0.1, 0.4) * normal(generator);
        units.push_back(weekly(values, 0.1));
    }
    const WithinScatter scatter(uncut(units));
    const Scatter common = common_scatter({&scatter, 1}, std::vector<std::optional<std::size_t>>(1));
    EXPECT_GE(common.degrees, 60.0);
    EXPECT_NEAR(scatter.of_all(common).std, 0.4, 0.05);
}

TEST(WithinScatter_, UnitThatDrifts_IsJudgedByTheOthers) {
    std::vector<std::vector<Point>> units(10, weekly({0.0, 0.1, 0.0, -0.1, 0.0, 0.1}, 0.1));
    units[3] = weekly({0.0, 5.0, 10.0, 15.0, 20.0, 25.0}, 0.1);
    const WithinScatter scatter(uncut(units));
    EXPECT_LT(scatter.without(3, {0.0, 100.0}).std, 0.1);
    EXPECT_GT(scatter.without(4, {0.0, 100.0}).std, 1.0);
}

TEST(ChangePoints_, NothingChanges_NothingIsFound) {
    const auto points = weekly({1.0, 1.1, 0.9, 1.0, 1.05, 0.95, 1.0, 1.1}, 0.1);
    EXPECT_TRUE(find_changes(points, {0.0, 100.0}, alarm_bound(50, 52, 0.05)).empty());
}

TEST(ChangePoints_, Step_IsDatedToItsWeek) {
    const auto points = weekly({1.0, 1.1, 0.9, 1.0, 4.05, 3.95, 4.0, 4.1}, 0.1);
    const auto changes = find_changes(points, {0.0, 100.0}, alarm_bound(50, 52, 0.05));
    ASSERT_EQ(changes.size(), 1U);
    EXPECT_EQ(changes[0].kind, ChangeKind::step);
    EXPECT_EQ(changes[0].first, 4U);
    EXPECT_EQ(changes[0].earliest, 4U);
    EXPECT_EQ(changes[0].latest, 4U);
    EXPECT_NEAR(changes[0].size, 4.025 - 1.0, 1e-9);
    EXPECT_NEAR(changes[0].std, std::sqrt(0.01 / 4.0 + 0.01 / 4.0), 1e-9);
    EXPECT_EQ(changes[0].found, 5U) << "one diagnosis alone is no alarm";
}

TEST(ChangePoints_, Trend_HasItsSlopeAndGoesOn) {
    const auto points = weekly({0.0, 0.1, -0.1, 0.0, 1.0, 2.1, 2.9, 4.0}, 0.1);
    const auto changes = find_changes(points, {0.0, 100.0}, alarm_bound(50, 52, 0.05));
    ASSERT_EQ(changes.size(), 1U);
    EXPECT_EQ(changes[0].kind, ChangeKind::trend);
    EXPECT_EQ(changes[0].first, 4U);
    EXPECT_NEAR(changes[0].size, 1.0, 0.05);
    EXPECT_NEAR(level_now(points, {0.0, 100.0}, changes).value, 4.0, 0.1);
}

TEST(ChangePoints_, OneDiagnosisThatIsWrong_IsNoChange) {
    const auto points = weekly({0.0, 0.1, -0.1, 0.0, 9.0, 0.1, 0.0, -0.1}, 0.1);
    EXPECT_TRUE(find_changes(points, {0.0, 100.0}, alarm_bound(50, 52, 0.05)).empty());
}

TEST(ChangePoints_, StepAndRepair_AreBothFound) {
    const auto points = weekly({0.0, 0.1, -0.1, 3.0, 3.1, 2.9, 3.0, 0.0, 0.1, -0.1, 0.0}, 0.1);
    const auto changes = find_changes(points, {0.0, 100.0}, alarm_bound(50, 52, 0.05));
    ASSERT_EQ(changes.size(), 2U);
    EXPECT_EQ(changes[0].first, 3U);
    EXPECT_EQ(changes[1].first, 7U);
    EXPECT_NEAR(changes[1].size, -3.0, 0.1);
}

TEST(ChangePoints_, LongTimeWithoutAName_CountsAsOneDiagnosis) {
    std::vector<Point> points(44);
    for (int week = 0; week < 44; ++week)
        points[static_cast<std::size_t>(week)] = week < 40
                                                     ? Point{static_cast<double>(week), 0.0, 0.02, 0.458}
                                                     : Point{static_cast<double>(week), 0.47, 0.02};
    EXPECT_TRUE(find_changes(points, {0.0, 100.0}, alarm_bound(50, 52, 0.05)).empty());
}

/// After the repair no diagnosis names the quantity any more: the alarm rests on the second of these.
TEST(ChangePoints_, RepairAfterWhichNothingIsNamed_IsFoundWhileThatLasts) {
    std::vector<Point> points = weekly({7.5, 7.6, 7.4, 7.5, 7.55, 7.45, 7.5, 7.6}, 0.1);
    points.push_back({8.0, 0.0, 0.1, 0.458});
    EXPECT_TRUE(find_changes(points, {0.0, 100.0}, alarm_bound(50, 52, 0.05)).empty())
        << "one diagnosis alone is no alarm";
    for (int week = 9; week < 12; ++week) points.push_back({static_cast<double>(week), 0.0, 0.1, 0.458});
    const auto changes = find_changes(points, {0.0, 100.0}, alarm_bound(50, 52, 0.05));
    ASSERT_EQ(changes.size(), 1U);
    EXPECT_EQ(changes[0].first, 8U);
    EXPECT_EQ(changes[0].found, 9U);
    EXPECT_LT(changes[0].size, -6.5);
    const Level now = level_now(points, {0.0, 100.0}, changes);
    EXPECT_DOUBLE_EQ(now.value, 0.0);
    EXPECT_DOUBLE_EQ(now.limit, 0.458);
}

/// Of many diagnoses that see nothing all count in the level, though they are one in an alarm.
TEST(ChangePoints_, OneBadWeekOfMany_HardlyMovesTheLevel) {
    std::vector<Point> points(52);
    for (int week = 0; week < 52; ++week)
        points[static_cast<std::size_t>(week)] = {static_cast<double>(week), 0.0, 0.1, 0.458};
    points[20] = {20.0, 6.0, 0.1};
    const Scatter scatter{0.18, 100.0};
    const auto changes = find_changes(points, scatter, alarm_bound(50, 52, 0.05));
    EXPECT_TRUE(changes.empty());
    EXPECT_LT(level_now(points, scatter, changes).value, 0.7);
}

/// What is named is a selection: the level of those below the limit is known by how often they are named.
TEST(ChangePoints_, LevelBelowTheLimit_IsNotBiasedByWhatIsNamed) {
    constexpr unsigned seed = 3;
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    const Scatter scatter{0.18, 1e5};
    const double truth = 0.30, std = 0.1;
    double sum = 0.0;
    constexpr int units = 40;
    for (int unit = 0; unit < units; ++unit) {
        std::vector<Point> points;
        for (int week = 0; week < 52; ++week) {
            const double value = truth + std::hypot(std, scatter.std) * normal(generator);
            points.push_back(std::abs(value) < 0.458 ? Point{static_cast<double>(week), 0.0, std, 0.458}
                                                     : Point{static_cast<double>(week), value, std});
        }
        sum += level_now(points, scatter, {}).value;
    }
    EXPECT_NEAR(sum / units, truth, 0.02) << "seed " << seed;
}

TEST(ChangePoints_, AllLooksOfManyYears_RaiseNoMoreAlarmsThanTheBoundAllows) {
    constexpr unsigned seed = 17;
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    // One quantity, a bound of 200 looks: 0.005 alarms a look at most.
    constexpr int units = 600, looks = 20;
    int alarms = 0;
    for (int unit = 0; unit < units; ++unit) {
        std::vector<double> values(looks);
        for (double& value : values) value = normal(generator);
        alarms += find_changes(weekly(values, 1.0), {0.0, 1e5}, 200.0).empty() ? 0 : 1;
    }
    EXPECT_LE(alarms, units * looks / 200.0 + 3.0 * std::sqrt(units * looks / 200.0)) << "seed " << seed;
}

/// While three are off, the spread of units explains each of them.
TEST(Attribution_, SeveralOddUnits_DoNotHideEachOther) {
    struct Odd {
        std::size_t units;
        bool are_alike;
    };
    for (const auto& [odd, are_alike] :
         {Odd{1, true}, Odd{2, true}, Odd{3, true}, Odd{5, true}, Odd{2, false}, Odd{5, false}}) {
        std::vector<Level> levels(50, Level{0.0, 0.1});
        for (std::size_t u = 0; u < levels.size(); ++u)
            levels[u].value = 0.3 * std::sin(static_cast<double>(7 * u + 1));
        for (std::size_t u = 0; u < odd; ++u) levels[9 * u].value += are_alike || u % 2 == 0 ? 10.0 : -10.0;
        const Attribution found = attribute(levels, {}, 50);
        ASSERT_EQ(found.shares.size(), odd);
        for (const Share& share : found.shares) {
            EXPECT_EQ(share.whose, Whose::unit);
            EXPECT_EQ(*share.which % 9, 0U);
            EXPECT_NEAR(std::abs(share.size.value), 10.0, 0.7);
            EXPECT_GT(share.log_odds, std::log(19.0));
        }
    }
}

TEST(Attribution_, UnitsThatDifferAnyway_HaveNoShares) {
    constexpr unsigned seed = 8;
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    int with_shares = 0;
    constexpr int fleets = 100;
    for (int fleet = 0; fleet < fleets; ++fleet) {
        std::vector<Level> levels(30);
        for (Level& level : levels) level = {2.0 * normal(generator), 0.1};
        with_shares += attribute(levels, {}, 50).shares.empty() ? 0 : 1;
    }
    EXPECT_LE(with_shares, fleets / 19) << "seed " << seed;
}

TEST(Attribution_, AllAtOneValue_IsTheModels) {
    const std::vector<Level> levels(20, Level{2.0, 0.1});
    const Attribution found = attribute(levels, {}, 50);
    ASSERT_EQ(found.shares.size(), 1U);
    EXPECT_EQ(found.shares[0].whose, Whose::all);
    EXPECT_NEAR(found.shares[0].size.value, 2.0, 0.01);
    EXPECT_GT(found.shares[0].probability, 0.99);
    EXPECT_EQ(found.spread, 0.0);
}

TEST(Attribution_, OneUnitOff_IsThatUnits) {
    std::vector<Level> levels(20, Level{0.0, 0.1});
    levels[7].value = 2.0;
    const Attribution found = attribute(levels, {}, 50);
    ASSERT_EQ(found.shares.size(), 1U);
    EXPECT_EQ(found.shares[0].whose, Whose::unit);
    EXPECT_EQ(found.shares[0].which, 7U);
}

TEST(Attribution_, UnitsOfABatchOff_IsTheBatchs) {
    std::vector<Level> levels(20, Level{0.0, 0.1});
    std::vector<std::vector<std::size_t>> groups{{0, 1, 2, 3}, {4, 5, 6, 7}};
    for (const std::size_t unit : groups[1]) levels[unit].value = 2.0;
    const Attribution found = attribute(levels, groups, 50);
    ASSERT_EQ(found.shares.size(), 1U);
    EXPECT_EQ(found.shares[0].whose, Whose::group);
    EXPECT_EQ(found.shares[0].which, 1U);
}

TEST(Attribution_, AllAndOneMore_AreTwoShares) {
    std::vector<Level> levels(20, Level{2.0, 0.1});
    levels[3].value = 7.0;
    const Attribution found = attribute(levels, {}, 50);
    ASSERT_EQ(found.shares.size(), 2U);
    EXPECT_EQ(found.shares[0].whose, Whose::all);
    EXPECT_EQ(found.shares[1].whose, Whose::unit);
    EXPECT_NEAR(found.shares[1].size.value, 5.0, 0.1);
}

TEST(Attribution_, NothingOff_IsNobodys) {
    constexpr unsigned seed = 9;
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    std::vector<Level> levels(50);
    for (Level& level : levels) level = {0.5 * normal(generator), 0.1};
    EXPECT_TRUE(attribute(levels, {}, 50).shares.empty()) << "seed " << seed;
}

TEST(Attribution_, TwoUnits_CannotBeToldApart) {
    EXPECT_TRUE(attribute(std::vector<Level>{{5.0, 0.1}, {0.0, 0.1}}, {}, 50).shares.empty());
}

}  // namespace
}  // namespace fidservo::fleet
