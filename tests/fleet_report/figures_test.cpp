// SPDX-License-Identifier: GPL-3.0-or-later
// How well fleets are judged, on histories drawn at the level of parameters.
#include "src/fleet/report/findings.h"
#include "tests/fleet_report/drawn_fleet.h"

#include <algorithm>
#include <cstdio>
#include <map>

#include <gtest/gtest.h>

namespace fidservo::fleet {
namespace {

/// A fleet of one effect more than usual in one place.
DrawnFleet fleet_of(std::uint64_t seed, std::size_t weeks) {
    DrawnFleet fleet;
    fleet.seed = seed;
    fleet.weeks = weeks;
    return fleet;
}

/// Changes of a fleet by the unit's name and the effect.
std::map<std::pair<std::string, std::string>, std::vector<Change>> changes_of(const FleetFindings& findings) {
    std::map<std::pair<std::string, std::string>, std::vector<Change>> changes;
    for (const QuantityFindings& found : findings.quantities)
        for (const UnitFindings& unit : found.units)
            if (!unit.changes.empty())
                changes[{findings.units[unit.series.unit].name, found.quantity.effect}] = unit.changes;
    return changes;
}

TEST(SlowFleetFigures, DriftOfAFloorAWeek_IsFoundWithinFourWeeks) {
    constexpr int histories = 200;
    int found = 0, false_alarms = 0;
    for (int history = 0; history < histories; ++history) {
        const auto seed = 91'000ULL + static_cast<std::uint64_t>(history);
        const std::size_t onset = 2 + seed % 3, unit = seed % 50, effect = seed % drawn_effects().size();
        DrawnFleet fleet = fleet_of(seed, onset + 4);
        fleet.truth = [&](std::size_t e, std::size_t u, std::size_t week) {
            return e == effect && u == unit && week >= onset ? static_cast<double>(week - onset + 1) : 0.0;
        };
        const std::string name = "P-" + std::string(unit + 1 < 10 ? "000" : "00") + std::to_string(unit + 1);
        for (const auto& [where, changes] : changes_of(findings_of(draw(fleet)))) {
            if (where.first == name && where.second == drawn_effects()[effect].effect)
                found += 1;
            else
                false_alarms += 1;
        }
    }
    std::printf("drift of a floor a week: found within 4 weeks %d of %d, others %d\n", found, histories,
                false_alarms);
    EXPECT_GE(found, 180);
}

TEST(SlowFleetFigures, NothingDrifts_FewFalseAlarmsAUnitYear) {
    constexpr int fleets = 10;
    std::size_t alarms = 0;
    for (int k = 0; k < fleets; ++k)
        for (const auto& [where, changes] :
             changes_of(findings_of(draw(fleet_of(92'000ULL + static_cast<std::uint64_t>(k), 52)))))
            alarms += changes.size();
    const double unit_years = fleets * 50.0;
    std::printf("false alarms: %zu in %.0f unit-years\n", alarms, unit_years);
    EXPECT_LE(static_cast<double>(alarms) / unit_years, 0.05);
}

TEST(SlowFleetFigures, Step_IsDatedToItsWeek) {
    constexpr int histories = 100;
    int dated = 0, covered = 0;
    for (int history = 0; history < histories; ++history) {
        const auto seed = 93'000ULL + static_cast<std::uint64_t>(history);
        const std::size_t at = 4 + seed % 5, unit = seed % 50, effect = seed % drawn_effects().size();
        DrawnFleet fleet = fleet_of(seed, 12);
        fleet.truth = [&](std::size_t e, std::size_t u, std::size_t week) {
            return e == effect && u == unit && week >= at ? 4.0 : 0.0;
        };
        const FleetFindings findings = findings_of(draw(fleet));
        for (const Judgement& judgement : findings.judgements) {
            if (judgement.matter != Matter::step || judgement.units != std::vector<std::size_t>{unit})
                continue;
            constexpr std::int64_t first_s = 1'772'409'600 + 28'800, week_s = 7 * 86'400;
            const std::int64_t true_s = first_s + static_cast<std::int64_t>(at) * week_s;
            dated += judgement.since->likeliest_s == true_s ? 1 : 0;
            covered += judgement.since->earliest_s < true_s && true_s <= judgement.since->latest_s ? 1 : 0;
        }
    }
    std::printf("step of four floors: dated to its week %d of %d, interval has it %d\n", dated, histories,
                covered);
    EXPECT_GE(dated, 95);
}

TEST(SlowFleetFigures, ModelBatchAndUnit_AreToldApart) {
    constexpr int fleets = 40;
    std::map<Whose, int> right;
    for (const Whose whose : {Whose::all, Whose::group, Whose::unit})
        for (int k = 0; k < fleets; ++k) {
            const auto seed =
                94'000ULL + 100ULL * static_cast<std::uint64_t>(whose) + static_cast<std::uint64_t>(k);
            const std::size_t effect = seed % drawn_effects().size(), unit = seed % 50, batch = seed % 5;
            DrawnFleet fleet = fleet_of(seed, 8);
            fleet.truth = [&](std::size_t e, std::size_t u, std::size_t) {
                const bool is_off =
                    whose == Whose::all || (whose == Whose::group && u % 5 == batch) || u == unit;
                return e == effect && is_off ? 4.0 : 0.0;
            };
            const FleetFindings findings = findings_of(draw(fleet));
            right[whose] += findings.judgements.size() == 1 && findings.judgements[0].whose == whose &&
                                    findings.judgements[0].matter == Matter::deviation &&
                                    findings.quantities[findings.judgements[0].quantity].quantity.effect ==
                                        drawn_effects()[effect].effect
                                ? 1
                                : 0;
        }
    std::printf("told apart, and nothing else said: all %d, batch %d, unit %d, each of %d\n",
                right[Whose::all], right[Whose::group], right[Whose::unit], fleets);
    EXPECT_GE(right[Whose::all] + right[Whose::group] + right[Whose::unit], 114);
}

}  // namespace
}  // namespace fidservo::fleet
