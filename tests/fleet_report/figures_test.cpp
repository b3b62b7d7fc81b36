// SPDX-License-Identifier: GPL-3.0-or-later
// How well fleets are judged, on histories drawn at the level of parameters, over a grid of sizes: the tables
// of docs/fleet-report.md.
#include "src/fleet/report/findings.h"
#include "tests/effort.h"
#include "tests/fleet_report/drawn_fleet.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fidservo::fleet {
namespace {

constexpr std::array sizes_floors{1.0, 2.0, 3.0, 4.0, 6.0, 10.0};
constexpr std::array drifts_floors_a_week{0.25, 0.5, 1.0, 2.0, 4.0};
constexpr std::size_t units = 50, batches = 5;

/// A quantity of a unit with a deviation.
struct Odd {
    std::uint64_t seed;
    std::size_t unit, effect, onset;

    explicit Odd(std::uint64_t number)
        : seed(number),
          unit(number % units),
          effect(number % drawn_effects().size()),
          onset(4 + number % 5) {}

    std::string name() const { return fmt::format("P-{:04}", unit + 1); }
};

DrawnFleet fleet_of(std::uint64_t seed, std::size_t weeks) {
    DrawnFleet fleet;
    fleet.seed = seed;
    fleet.units = units;
    fleet.batches = batches;
    fleet.weeks = weeks;
    return fleet;
}

/// The changes of one quantity of one unit, and how many others were found.
struct FoundChanges {
    std::vector<Change> own;
    std::size_t others = 0;
};

FoundChanges changes_of(const FleetFindings& findings, const Odd& odd) {
    FoundChanges changes;
    for (const QuantityFindings& found : findings.quantities)
        for (const UnitFindings& unit : found.units) {
            if (findings.units[unit.series.unit].name == odd.name() &&
                found.quantity.effect == drawn_effects()[odd.effect].effect)
                changes.own = unit.changes;
            else
                changes.others += unit.changes.size();
        }
    return changes;
}

/// What is found four weeks after a change began.
FoundChanges four_weeks_after(const Odd& odd, ChangeKind kind, double size) {
    DrawnFleet fleet = fleet_of(odd.seed, odd.onset + 4);
    fleet.truth = [&](std::size_t effect, std::size_t unit, std::size_t week) {
        if (effect != odd.effect || unit != odd.unit || week < odd.onset) return 0.0;
        return kind == ChangeKind::step ? size : size * static_cast<double>(week - odd.onset + 1);
    };
    return changes_of(findings_of(draw(fleet)), odd);
}

TEST(SlowFleetFigures, Drift_IsFoundWithinFourWeeks) {
    const int histories = testing::draws(200, 20);
    std::map<double, int> found;
    std::printf("| drift, floors a week | found within 4 weeks | others |\n");
    for (const double drift : drifts_floors_a_week) {
        std::size_t others = 0;
        for (int history = 0; history < histories; ++history) {
            const Odd odd(191'000ULL + static_cast<std::uint64_t>(history));
            const FoundChanges changes = four_weeks_after(odd, ChangeKind::trend, drift);
            found[drift] += changes.own.empty() ? 0 : 1;
            others += changes.others;
        }
        std::printf("| %g | %d of %d | %zu |\n", drift, found[drift], histories, others);
        std::fflush(stdout);
    }
    EXPECT_GE(found[1.0], 0.9 * histories);
}

TEST(SlowFleetFigures, Step_IsFoundAndDatedToItsWeek) {
    const int histories = testing::draws(100, 10);
    std::map<double, int> dated;
    std::printf("| step, floors | found within 4 weeks | dated to its week | interval has it | others |\n");
    for (const double size : sizes_floors) {
        int found = 0, covered = 0;
        std::size_t others = 0;
        for (int history = 0; history < histories; ++history) {
            const Odd odd(193'000ULL + static_cast<std::uint64_t>(history));
            const FoundChanges changes = four_weeks_after(odd, ChangeKind::step, size);
            others += changes.others;
            if (changes.own.empty()) continue;
            const Change& change = changes.own.front();
            found += 1;
            dated[size] +=
                changes.own.size() == 1 && change.kind == ChangeKind::step && change.first == odd.onset ? 1
                                                                                                        : 0;
            covered += change.earliest <= odd.onset && odd.onset <= change.latest ? 1 : 0;
        }
        std::printf("| %g | %d of %d | %d | %d | %zu |\n", size, found, histories, dated[size], covered,
                    others);
        std::fflush(stdout);
    }
    EXPECT_GE(dated[sizes_floors.back()], 0.95 * histories);
}

TEST(SlowFleetFigures, NothingDrifts_FewFalseAlarmsAUnitYear) {
    const int fleets = testing::draws(10, 2);
    std::size_t alarms = 0;
    for (int k = 0; k < fleets; ++k) {
        const FleetFindings findings =
            findings_of(draw(fleet_of(192'000ULL + static_cast<std::uint64_t>(k), 52)));
        for (const QuantityFindings& found : findings.quantities)
            for (const UnitFindings& unit : found.units) alarms += unit.changes.size();
    }
    const double unit_years = static_cast<double>(fleets) * units;
    std::printf("false alarms: %zu in %.0f unit-years\n", alarms, unit_years);
    EXPECT_LE(static_cast<double>(alarms) / unit_years, 0.05);
}

/// Whether a deviation of one quantity is attributed to the right unit, batch or all, and nothing else is
/// reported.
struct ToldApart {
    bool right = false, alone = false;
};

ToldApart told_apart(const Odd& odd, Whose whose, double size) {
    DrawnFleet fleet = fleet_of(odd.seed, 8);
    fleet.truth = [&](std::size_t effect, std::size_t unit, std::size_t) {
        const bool is_off = whose == Whose::all ||
                            (whose == Whose::group && unit % batches == odd.unit % batches) ||
                            unit == odd.unit;
        return effect == odd.effect && is_off ? size : 0.0;
    };
    const FleetFindings findings = findings_of(draw(fleet));
    const auto is_it = [&](const Judgement& judgement) {
        return judgement.whose == whose && judgement.matter == Matter::deviation &&
               findings.quantities[judgement.quantity].quantity.effect ==
                   drawn_effects()[odd.effect].effect &&
               (whose == Whose::all || std::ranges::find(judgement.units, odd.unit) != judgement.units.end());
    };
    return {std::ranges::any_of(findings.judgements, is_it), findings.judgements.size() == 1};
}

TEST(SlowFleetFigures, ModelBatchAndUnit_AreToldApart) {
    const int fleets = testing::draws(40, 4);
    std::map<double, int> apart;
    std::printf("| deviation, floors | all | batch | unit | right, but more is said |\n");
    for (const double size : sizes_floors) {
        std::map<Whose, int> right;
        int with_more = 0;
        for (const Whose whose : {Whose::all, Whose::group, Whose::unit})
            for (int k = 0; k < fleets; ++k) {
                const Odd odd(194'000ULL + 100ULL * static_cast<std::uint64_t>(whose) +
                              static_cast<std::uint64_t>(k));
                const ToldApart told = told_apart(odd, whose, size);
                right[whose] += told.right && told.alone ? 1 : 0;
                with_more += told.right && !told.alone ? 1 : 0;
            }
        apart[size] = right[Whose::all] + right[Whose::group] + right[Whose::unit];
        std::printf("| %g | %d of %d | %d | %d | %d |\n", size, right[Whose::all], fleets,
                    right[Whose::group], right[Whose::unit], with_more);
        std::fflush(stdout);
    }
    EXPECT_GE(apart[sizes_floors.back()], 0.95 * 3 * fleets);
}

}  // namespace
}  // namespace fidservo::fleet
