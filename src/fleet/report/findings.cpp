// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/findings.h"

#include "src/fleet/report/groups.h"
#include "src/fleet/report/statistics/censored.h"
#include "src/fleet/report/statistics/common_changes.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <tuple>

#include <fmt/format.h>

namespace fidservo::fleet {
namespace {

constexpr double much_the_same = 0.8;

std::span<const Point> timed(const UnitFindings& unit) {
    return std::span(unit.series.points).subspan(unit.series.untimed);
}

/// @param looks_a_year, bound  as in FleetFindings
CommonChanges in_common(const QuantityFindings& found, double looks_a_year, double bound) {
    constexpr double weeks_a_year = 365.25 / 7.0;
    std::vector<std::vector<Point>> points;
    for (const UnitFindings& unit : found.units) points.emplace_back(timed(unit).begin(), timed(unit).end());
    return common_changes(points, weeks_a_year / looks_a_year, bound);
}

WithinScatter scatter_of(const QuantityFindings& found, const CommonChanges& common) {
    std::vector<WithinScatter::Stretches> stretches;
    for (const UnitFindings& unit : found.units) stretches.push_back(stretches_of(timed(unit), common.cuts));
    return WithinScatter(stretches);
}

/// Of all quantities, for each unit of the fleet by the others.
std::vector<Scatter> scatter_by_others(const FleetFindings& findings,
                                       std::span<const WithinScatter> scatters) {
    std::vector<std::vector<std::optional<std::size_t>>> places(
        findings.units.size(), std::vector<std::optional<std::size_t>>(scatters.size()));
    for (std::size_t q = 0; q < scatters.size(); ++q)
        for (std::size_t place = 0; place < findings.quantities[q].units.size(); ++place)
            places[findings.quantities[q].units[place].series.unit][q] = place;
    std::vector<Scatter> by_others;
    by_others.reserve(places.size());
    for (const auto& unit : places) by_others.push_back(common_scatter(scatters, unit));
    return by_others;
}

/// What has changed, with the scatter of the units that have not.
void look_for_changes(QuantityFindings& found, WithinScatter scatter, std::span<const Scatter> common,
                      double bound, std::span<const CommonStep> in_common) {
    const auto of_others = [&](std::size_t u) {
        return scatter.without(u, common[found.units[u].series.unit]);
    };
    for (std::size_t u = 0; u < found.units.size(); ++u)
        found.units[u].changes = find_changes(timed(found.units[u]), of_others(u), bound, in_common);
    // Units that changed passed for scatter of the others.
    for (std::size_t u = 0; u < found.units.size(); ++u)
        if (!found.units[u].changes.empty()) scatter.leave_out(u);
    for (std::size_t u = 0; u < found.units.size(); ++u) {
        UnitFindings& unit = found.units[u];
        unit.changes = find_changes(timed(unit), of_others(u), bound, in_common);
        const std::span<const Point> all = unit.series.points;
        unit.known = level_now(unit.changes.empty() ? all : timed(unit), of_others(u), unit.changes);
        unit.level = as_normal(unit.known);
    }
    found.scatter = scatter.of_all(common.front());
}

void pool(QuantityFindings& found) {
    const std::vector<bool> odd = odd_units(found);
    std::vector<Level> alike;
    for (std::size_t u = 0; u < found.units.size(); ++u)
        if (!odd[u]) alike.push_back(found.units[u].known);
    if (alike.empty())
        for (const UnitFindings& unit : found.units) alike.push_back(unit.known);
    found.population = population_of(alike);
    for (std::size_t u = 0; u < found.units.size(); ++u)
        found.units[u].pooled =
            odd[u] ? found.units[u].level : pooled(found.units[u].known, found.population);
}

QuantityFindings unjudged(QuantityOverFleet fleet) {
    QuantityFindings found;
    found.quantity = std::move(fleet.quantity);
    for (QuantitySeries& series : fleet.units)
        found.units.push_back(
            {.series = std::move(series), .changes = {}, .known = {}, .level = {}, .pooled = {}});
    return found;
}

/// Whose the deviations are, and units' values given the fleet.
void attribute_and_pool(const std::vector<FleetResult>& results, const std::vector<UnitHistory>& histories,
                        QuantityFindings& found) {
    found.groups = groups_of(results, histories, found.units);
    std::vector<Level> levels;
    for (const UnitFindings& unit : found.units) levels.push_back(unit.known);
    std::vector<std::vector<std::size_t>> sets;
    for (const UnitGroup& group : found.groups) sets.push_back(group.units);
    found.attribution = attribute(levels, sets, static_cast<double>(quantities_looked_at()));
    pool(found);
}

std::vector<std::size_t> fleet_units(const QuantityFindings& found, const std::vector<std::size_t>& places) {
    std::vector<std::size_t> units;
    units.reserve(places.size());
    for (const std::size_t place : places) units.push_back(found.units[place].series.unit);
    return units;
}

double mean_level(const QuantityFindings& found, const std::vector<std::size_t>& places) {
    double sum = 0.0;
    for (const std::size_t place : places) sum += found.attribution.levels[place];
    return sum / static_cast<double>(places.size());
}

Judgement judgement_of(const std::vector<FleetResult>& results, const QuantityFindings& found,
                       std::size_t quantity, const ChangeCluster& cluster) {
    Judgement judgement;
    judgement.matter = cluster.kind == ChangeKind::step ? Matter::step : Matter::trend;
    judgement.quantity = quantity;
    judgement.units = fleet_units(found, cluster.units);
    judgement.now = mean_level(found, cluster.units);
    judgement.since = cluster.since;
    const double count = static_cast<double>(cluster.units.size());
    double variance = 0.0;
    for (std::size_t k = 0; k < cluster.units.size(); ++k) {
        const UnitFindings& unit = found.units[cluster.units[k]];
        const Change& change = unit.changes[cluster.changes[k]];
        judgement.size.value += change.size / count;
        variance += change.std * change.std / (count * count);
        judgement.log_odds = std::max(judgement.log_odds, change.log_evidence);
        const std::int64_t found_s = time_s_of(results, unit.series, change.found);
        judgement.found_s = std::min(judgement.found_s.value_or(found_s), found_s);
    }
    judgement.size.std = std::sqrt(variance);
    if (cluster.units.size() > 1) judgement.whose = Whose::group;
    if (count >= much_the_same * static_cast<double>(found.units.size()) && found.units.size() > 2)
        judgement.whose = Whose::all;
    for (const UnitGroup& group : found.groups)
        if (judgement.whose == Whose::group && overlap(group.units, cluster.units) >= much_the_same) {
            judgement.group = group.name;
            break;
        }
    return judgement;
}

/// Whether a unit's deviation is what a change of it comes to.
bool is_told_by(const Judgement& change, const Judgement& deviation) {
    if (change.quantity != deviation.quantity || deviation.whose != Whose::unit) return false;
    if (std::ranges::find(change.units, deviation.units.front()) == change.units.end()) return false;
    return change.matter == Matter::trend ||
           std::abs(deviation.now - change.size.value) < 0.5 * std::abs(deviation.now);
}

/// Whether the units at some places, and no others, have their rig files.
bool have_own_rig_files(const std::vector<FleetResult>& results, const std::vector<UnitHistory>& histories,
                        const QuantityFindings& found, const std::vector<std::size_t>& places) {
    std::set<std::string_view> theirs, others;
    for (std::size_t place = 0; place < found.units.size(); ++place)
        (std::ranges::binary_search(places, place) ? theirs : others)
            .insert(rig_file_of(results, histories[found.units[place].series.unit]));
    return !others.empty() &&
           std::ranges::none_of(theirs, [&](std::string_view file) { return others.contains(file); });
}

/// Units that share a deviation and that no label or date tells from the others.
std::string part_name(std::size_t units, std::size_t all) {
    const std::size_t tenths = 10 * units / all;
    return fmt::format("{}{} of {} units, which no label or date tells from the others",
                       tenths >= 4 && tenths < 6 ? "about half of the units, " : "", units, all);
}

void add_judgements(const std::vector<FleetResult>& results, const std::vector<UnitHistory>& histories,
                    const QuantityFindings& found, std::size_t quantity, std::vector<Judgement>& judgements) {
    std::vector<Judgement> changes;
    for (const ChangeCluster& cluster : clusters_of(results, found.units))
        changes.push_back(judgement_of(results, found, quantity, cluster));
    for (const Share& share : found.attribution.shares) {
        const std::vector<std::size_t>& places = share.units;
        Judgement judgement;
        judgement.whose = share.whose;
        judgement.quantity = quantity;
        judgement.units = fleet_units(found, places);
        if (share.whose == Whose::group)
            judgement.group =
                share.which ? found.groups[*share.which].name : part_name(places.size(), found.units.size());
        judgement.size = share.size;
        judgement.now = mean_level(found, places);
        judgement.is_beside_others = std::ranges::any_of(found.attribution.shares, [&](const Share& other) {
            return other.units.size() > places.size() && std::ranges::includes(other.units, places);
        });
        judgement.is_by_rig_file = have_own_rig_files(results, histories, found, places);
        judgement.probability = share.probability;
        judgement.log_odds = share.log_odds;
        judgement.log_all = share.log_all;
        judgement.log_group = share.log_group;
        judgement.log_unit = share.log_unit;
        if (std::ranges::any_of(changes,
                                [&](const Judgement& change) { return is_told_by(change, judgement); }))
            continue;
        const auto together = std::ranges::find_if(changes, [&](const Judgement& change) {
            return share.whose != Whose::unit && overlap(change.units, judgement.units) >= much_the_same;
        });
        if (together != changes.end()) {
            if (together->whose == Whose::all) {
                judgement.whose = Whose::all;
                judgement.group.clear();
            }
            judgement.matter = together->matter;
            judgement.units = together->units;
            judgement.now = together->now;
            judgement.since = together->since;
            judgement.found_s = together->found_s;
            judgement.size = together->size;
            changes.erase(together);
        }
        judgements.push_back(std::move(judgement));
    }
    for (Judgement& change : changes) judgements.push_back(std::move(change));
}

}  // namespace

std::vector<bool> odd_units(const QuantityFindings& found) {
    std::vector<bool> odd(found.units.size(), false);
    for (const Share& share : found.attribution.shares)
        if (share.whose != Whose::all)
            for (const std::size_t u : share.units) odd[u] = true;
    return odd;
}

FleetFindings findings_of(const std::vector<FleetResult>& results) {
    FleetFindings findings;
    findings.units = histories(results);
    findings.unexplained = unexplained_of(results, findings.units);
    findings.looks_a_year = looks_a_year(results, findings.units);
    findings.bound = alarm_bound(static_cast<double>(quantities_looked_at()), findings.looks_a_year,
                                 false_alarms_a_unit_year);
    std::vector<WithinScatter> scatters;
    std::vector<CommonChanges> common_to_units;
    for (QuantityOverFleet& fleet : quantities_over_fleet(results, findings.units)) {
        findings.quantities.push_back(unjudged(std::move(fleet)));
        common_to_units.push_back(
            in_common(findings.quantities.back(), findings.looks_a_year, findings.bound));
        scatters.push_back(scatter_of(findings.quantities.back(), common_to_units.back()));
    }
    const std::vector<Scatter> common = scatter_by_others(findings, scatters);
    for (std::size_t q = 0; q < findings.quantities.size(); ++q) {
        look_for_changes(findings.quantities[q], std::move(scatters[q]), common, findings.bound,
                         common_to_units[q].steps);
        attribute_and_pool(results, findings.units, findings.quantities[q]);
    }
    for (std::size_t q = 0; q < findings.quantities.size(); ++q)
        add_judgements(results, findings.units, findings.quantities[q], q, findings.judgements);
    std::ranges::stable_sort(findings.judgements, {}, [](const Judgement& judgement) {
        return std::tuple(judgement.whose, -std::abs(judgement.now));
    });
    return findings;
}

}  // namespace fidservo::fleet
