// SPDX-License-Identifier: GPL-3.0-or-later
// Whose a deviation is: a part of the units, and levels below what is named.
#include "src/fleet/report/findings.h"
#include "src/fleet/report/statistics/attribution.h"
#include "src/fleet/report/statistics/limited_sizes.h"
#include "tests/fleet_report/drawn_fleet.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::fleet {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr std::uint64_t seed = 41'400;

DrawnFleet without_batches(std::uint64_t number = seed) {
    DrawnFleet fleet;
    fleet.seed = number;
    fleet.batches = 1;
    return fleet;
}

TEST(PartOfTheUnits, EverySecondUnitOff_IsToldAsHalfOfThem) {
    DrawnFleet fleet = without_batches();
    fleet.truth = [](std::size_t effect, std::size_t unit, std::size_t) {
        return effect == 1 && unit % 2 == 0 ? 5.0 : 0.0;
    };
    const FleetFindings findings = findings_of(draw(fleet));
    ASSERT_THAT(findings.judgements, SizeIs(1)) << "seed " << seed;
    const Judgement& half = findings.judgements.front();
    EXPECT_EQ(half.whose, Whose::group);
    EXPECT_THAT(half.group, HasSubstr("about half of the units, 25 of 50"));
    EXPECT_NEAR(half.size.value, 5.0, 0.3);
    ASSERT_THAT(half.units, SizeIs(25));
    for (const std::size_t unit : half.units) EXPECT_EQ(unit % 2, 0U);
}

TEST(PartOfTheUnits, HalfOffAndAnotherUnitToo_AreTwoShares) {
    std::vector<Level> levels(40, Level{0.0, 0.1});
    for (std::size_t u = 0; u < levels.size(); u += 2) levels[u].value = 5.0;
    levels[7].value = -9.0;
    const Attribution found = attribute(levels, {}, 50);
    ASSERT_THAT(found.shares, SizeIs(2));
    const auto half = std::ranges::find(found.shares, Whose::group, &Share::whose),
               unit = std::ranges::find(found.shares, Whose::unit, &Share::whose);
    ASSERT_TRUE(half != found.shares.end() && unit != found.shares.end());
    EXPECT_THAT(half->units, SizeIs(20));
    EXPECT_FALSE(half->which.has_value());
    EXPECT_EQ(unit->which, 7U);
}

TEST(PartOfTheUnits, UnitsThatDifferEvenly_HaveNoParts) {
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> even(-5.0, 5.0);
    for (const std::size_t units : std::vector<std::size_t>{6, 20, 50, 200})
        for (int fleet = 0; fleet < 10; ++fleet) {
            std::vector<Level> levels(units);
            for (Level& level : levels) level = {even(generator), 0.1};
            EXPECT_TRUE(attribute(levels, {}, 50).shares.empty()) << units << " units, seed " << seed;
        }
}

/// Units that happen to be named differ from those that are not.
TEST(PartOfTheUnits, ThoseThatAreNamed_AreNoPart) {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    constexpr double limit = 0.458, std = 0.06, spread = 0.2, mean = 0.1;
    for (int fleet = 0; fleet < 20; ++fleet) {
        std::vector<Level> levels;
        for (int unit = 0; unit < 200; ++unit) {
            const double value = mean + std::hypot(std, spread) * normal(generator);
            levels.push_back(std::abs(value) < limit ? Level{0.0, std, limit} : Level{value, std});
        }
        for (const Share& share : attribute(levels, {}, 50).shares)
            EXPECT_TRUE(share.which.has_value()) << share.units.size() << " units, seed " << seed;
    }
}

TEST(LimitedSizes, AllNamed_IsLeastSquares) {
    const std::vector<Level> levels{{2.0, 0.1}, {2.2, 0.1}, {1.8, 0.1}};
    TakenShares taken(3);
    taken.take(std::vector<std::size_t>{0, 1, 2}, 64.0);
    const LimitedSizes found = limited_sizes(levels, taken);
    EXPECT_NEAR(found.sizes[0].value, 2.0, 1e-3);
    EXPECT_EQ(found.levels[1], 2.2);
}

/// What is named is a selection from what is just below the limit; the units that are never named do not say
/// that they have nothing.
TEST(LimitedSizes, UnitsOfWhichMostAreNeverNamed_SizeIsNotDrawnToNothing) {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    constexpr double limit = 0.458, std = 0.1, spread = 0.2, truth = 0.3;
    std::vector<Level> levels;
    std::vector<std::size_t> all;
    for (std::size_t u = 0; u < 1000; ++u) {
        const double value = truth + std::hypot(std, spread) * normal(generator);
        levels.push_back(std::abs(value) < limit ? Level{0.0, std, limit} : Level{value, std});
        all.push_back(u);
    }
    TakenShares taken(1000);
    taken.take(all, 1.0);
    const LimitedSizes found = limited_sizes(levels, taken);
    EXPECT_NEAR(found.sizes[0].value, truth, 0.03) << "seed " << seed;
    EXPECT_NEAR(found.spread, spread, 0.06) << "seed " << seed;
}

TEST(LimitedSizes, FleetBelowTheLimit_IsToldAtItsValue) {
    DrawnFleet fleet = without_batches();
    fleet.spread_floors = 0.1;
    fleet.truth = [](std::size_t effect, std::size_t, std::size_t) { return effect == 1 ? 0.3 : 0.0; };
    const FleetFindings findings = findings_of(draw(fleet));
    ASSERT_THAT(findings.judgements, SizeIs(1)) << "seed " << seed;
    EXPECT_EQ(findings.judgements.front().whose, Whose::all);
    EXPECT_NEAR(findings.judgements.front().size.value, 0.3, 0.05);
    EXPECT_NEAR(findings.judgements.front().now, 0.3, 0.05);
}

}  // namespace
}  // namespace fidservo::fleet
