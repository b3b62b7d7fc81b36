// SPDX-License-Identifier: GPL-3.0-or-later
// Changes of most units at one time.
#include "src/fleet/report/statistics/common_changes.h"

#include "src/fleet/report/findings.h"
#include "src/fleet/report/judgement_words.h"
#include "src/fleet/report/statistics/change_points.h"
#include "tests/fleet_report/drawn_fleet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::fleet {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::uint64_t seed = 41'300;
constexpr std::size_t onset = 4;

/// Units of which the first few are off by so much from the fifth week on.
FleetFindings findings_with(std::size_t stepping, double floors, std::size_t weeks = 8) {
    DrawnFleet fleet;
    fleet.seed = seed;
    fleet.weeks = weeks;
    fleet.truth = [=](std::size_t effect, std::size_t unit, std::size_t week) {
        return effect == 1 && unit < stepping && week >= onset ? floors : 0.0;
    };
    return findings_of(draw(fleet));
}

/// Weekly points of units with a scatter of their own and one that all share.
std::vector<std::vector<Point>> weekly_units(std::mt19937_64& generator, double own, double shared) {
    std::normal_distribution<double> normal;
    std::vector<std::vector<Point>> units(20);
    for (int week = 0; week < 20; ++week) {
        const double of_all = shared * normal(generator);
        for (std::vector<Point>& unit : units)
            unit.push_back({static_cast<double>(week), 3.0 + of_all + own * normal(generator), 0.1});
    }
    return units;
}

TEST(CommonChanges, FourInFiveUnitsStepAtOnce_IsAChangeOfTheFleetAtThatDate) {
    const FleetFindings findings = findings_with(40, 3.0);
    ASSERT_THAT(findings.judgements, SizeIs(1)) << "seed " << seed;
    const Judgement& step = findings.judgements.front();
    EXPECT_EQ(step.matter, Matter::step);
    EXPECT_EQ(step.whose, Whose::all);
    EXPECT_THAT(step.units, SizeIs(40));
    EXPECT_NEAR(step.size.value, 3.0, 0.2);
    EXPECT_EQ(date_of(step.since->likeliest_s), "2026-03-30");
    EXPECT_EQ(whose_words(findings, step), "40 of 50 units, since the same date");
}

TEST(CommonChanges, AllUnitsStepAtOnce_ModelIsNotSaidToBeWrong) {
    const FleetFindings findings = findings_with(50, 3.0);
    ASSERT_THAT(findings.judgements, SizeIs(1)) << "seed " << seed;
    EXPECT_EQ(findings.judgements.front().matter, Matter::step);
    EXPECT_EQ(whose_words(findings, findings.judgements.front()), "All units");
    EXPECT_NEAR(findings.judgements.front().now, 3.0, 0.2);
}

/// A step that no unit by itself raises an alarm for.
TEST(CommonChanges, AllUnitsStepByOneFloorAtOnce_IsAChangeOfTheFleet) {
    const FleetFindings findings = findings_with(50, 1.0, 12);
    ASSERT_THAT(findings.judgements, SizeIs(1)) << "seed " << seed;
    EXPECT_EQ(findings.judgements.front().matter, Matter::step);
    EXPECT_EQ(findings.judgements.front().whose, Whose::all);
    EXPECT_NEAR(findings.judgements.front().size.value, 1.0, 0.15);
}

TEST(CommonChanges, HalfOfTheUnitsStepAtOnce_AreToldAsThese) {
    const FleetFindings findings = findings_with(25, 3.0);
    ASSERT_THAT(findings.judgements, SizeIs(1)) << "seed " << seed;
    EXPECT_EQ(findings.judgements.front().matter, Matter::step);
    EXPECT_EQ(findings.judgements.front().whose, Whose::group);
    EXPECT_THAT(findings.judgements.front().units, SizeIs(25));
}

/// A room that is colder and warmer from week to week moves all units, and changes none.
TEST(CommonChanges, ScatterThatAllUnitsShare_IsNoChange) {
    std::mt19937_64 generator(seed);
    constexpr int fleets = 100, looks = 20;
    constexpr double bound = 200.0;
    int alarms = 0;
    for (int fleet = 0; fleet < fleets; ++fleet)
        alarms += common_changes(weekly_units(generator, 0.15, 1.0), 1.0, bound).cuts.empty() ? 0 : 1;
    const double most = fleets * looks / bound;
    EXPECT_LE(alarms, most + 3.0 * std::sqrt(most)) << "seed " << seed;
}

TEST(CommonChanges, OneWeekInWhichAllAreOff_IsNoChange) {
    std::mt19937_64 generator(seed);
    std::vector<std::vector<Point>> units = weekly_units(generator, 0.15, 0.0);
    for (std::vector<Point>& unit : units) unit[12].value += 8.0;
    EXPECT_THAT(common_changes(units, 1.0, alarm_bound(50, 52, 0.05)).cuts, IsEmpty());
}

TEST(CommonChanges, UnitsOfOtherDaysAndOfFewerWeeks_AreCutAboutTheStep) {
    std::mt19937_64 generator(seed);
    std::vector<std::vector<Point>> units = weekly_units(generator, 0.15, 0.0);
    for (std::size_t u = 0; u < units.size(); ++u) {
        units[u].erase(units[u].begin(), units[u].begin() + static_cast<std::ptrdiff_t>(u % 5));
        for (Point& point : units[u]) {
            point.time_weeks += 0.02 * static_cast<double>(u);
            if (point.time_weeks >= 12.0) point.value += 3.0;
        }
    }
    EXPECT_THAT(common_changes(units, 1.0, alarm_bound(50, 52, 0.05)).cuts, ElementsAre(11.0, 12.0, 13.0));
}

TEST(CommonChanges, Series_IsCutIntoStretches) {
    const std::array points{Point{0.0, 1.0, 0.1}, Point{1.0, 2.0, 0.1}, Point{2.0, 3.0, 0.1},
                            Point{5.0, 4.0, 0.1}};
    const auto stretches = stretches_of(points, std::array{-1.0, 1.0, 3.0, 4.0, 9.0});
    EXPECT_THAT(stretches, ElementsAre(SizeIs(1), SizeIs(2), SizeIs(1)));
    EXPECT_THAT(stretches_of(points, {}), ElementsAre(SizeIs(4)));
}

}  // namespace
}  // namespace fidservo::fleet
