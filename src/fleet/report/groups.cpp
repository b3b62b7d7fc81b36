// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/groups.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace fidservo::fleet {
namespace {

using UnitPlaces = std::vector<std::size_t>;

void add_group(std::vector<UnitGroup>& groups, std::size_t all, std::string name, UnitPlaces units) {
    if (units.size() < 2 || units.size() >= all) return;
    for (UnitGroup& group : groups)
        if (group.units == units) {
            group.name += ", " + name;
            return;
        }
    groups.push_back({std::move(name), std::move(units)});
}

std::int64_t monday_of(std::int64_t time_s) {
    constexpr std::int64_t day_s = 86'400, week_s = 7 * day_s, first_monday_s = 4 * day_s;
    const std::int64_t since = time_s - first_monday_s;
    const std::int64_t weeks = since >= 0 ? since / week_s : -((-since + week_s - 1) / week_s);
    return first_monday_s + weeks * week_s;
}

/// One change of one unit.
struct OneChange {
    std::size_t unit, change;
    ChangeKind kind;
    bool up;
    Dates dates;
};

/// The time that two intervals share; empty where that is less than half of the shorter one. Units that are
/// recorded one after the other have intervals that begin and end a little apart.
std::optional<Dates> shared(const Dates& a, const Dates& b) {
    Dates both{std::max(a.earliest_s, b.earliest_s), a.likeliest_s, std::min(a.latest_s, b.latest_s)};
    const std::int64_t shorter = std::min(a.latest_s - a.earliest_s, b.latest_s - b.earliest_s);
    if (2 * (both.latest_s - both.earliest_s) < shorter) return {};
    return both;
}

/// Changes of as many units that may be one with the first of them: places in `left`, and the time that all
/// their intervals share.
struct Together {
    std::vector<std::size_t> places;
    Dates since;
};

Together together_with(std::size_t seed, const std::vector<OneChange>& left) {
    Together found{{seed}, left[seed].dates};
    std::set<std::size_t> units{left[seed].unit};
    for (std::size_t k = 0; k < left.size(); ++k) {
        if (left[k].kind != left[seed].kind || left[k].up != left[seed].up || units.contains(left[k].unit))
            continue;
        const auto since = shared(found.since, left[k].dates);
        if (!since) continue;
        found.since = *since;
        found.places.push_back(k);
        units.insert(left[k].unit);
    }
    std::ranges::sort(found.places);
    return found;
}

}  // namespace

std::vector<UnitGroup> groups_of(const std::vector<FleetResult>& results,
                                 const std::vector<UnitHistory>& histories,
                                 std::span<const UnitFindings> units) {
    std::map<std::pair<std::string, std::string>, UnitPlaces> by_label;
    std::map<std::int64_t, UnitPlaces> by_first_week;
    std::map<std::string, UnitPlaces> by_rig_file;
    for (std::size_t place = 0; place < units.size(); ++place) {
        const std::vector<std::size_t>& of_unit = histories[units[place].series.unit].results;
        for (const auto& label : results[of_unit.back()].labels) by_label[label].push_back(place);
        by_rig_file[rig_file_of(results, histories[units[place].series.unit])].push_back(place);
        const auto first = std::ranges::find_if(
            of_unit, [&](std::size_t r) { return results[r].recorded_at_s.has_value(); });
        if (first != of_unit.end()) by_first_week[monday_of(*results[*first].recorded_at_s)].push_back(place);
    }
    std::vector<UnitGroup> groups;
    for (auto& [label, places] : by_label)
        add_group(groups, units.size(), label.first + " " + label.second, std::move(places));
    for (auto& [rig_file, places] : by_rig_file)
        add_group(groups, units.size(), fmt::format("rig file {:.12}", rig_file), std::move(places));
    for (auto& [week_s, places] : by_first_week)
        add_group(groups, units.size(), "first recorded in the week of " + date_of(week_s),
                  std::move(places));
    for (const ChangeCluster& cluster : clusters_of(results, units)) {
        UnitPlaces places = cluster.units;
        std::ranges::sort(places);
        add_group(groups, units.size(), "changed on the same date, " + date_of(cluster.since.likeliest_s),
                  std::move(places));
    }
    return groups;
}

std::vector<ChangeCluster> clusters_of(const std::vector<FleetResult>& results,
                                       std::span<const UnitFindings> units) {
    std::vector<OneChange> left;
    for (std::size_t u = 0; u < units.size(); ++u)
        for (std::size_t c = 0; c < units[u].changes.size(); ++c) {
            const Change& change = units[u].changes[c];
            left.push_back({u, c, change.kind, change.size > 0.0, dates_of(results, units[u], change)});
        }
    std::vector<ChangeCluster> clusters;
    while (!left.empty()) {
        Together best;
        for (std::size_t seed = 0; seed < left.size(); ++seed)
            if (Together found = together_with(seed, left); found.places.size() > best.places.size())
                best = std::move(found);
        ChangeCluster cluster{left[best.places.front()].kind, {}, {}, best.since};
        std::map<std::int64_t, int> votes{{best.since.latest_s, 0}};
        for (const std::size_t k : best.places) {
            cluster.units.push_back(left[k].unit);
            cluster.changes.push_back(left[k].change);
            const std::int64_t likeliest_s = left[k].dates.likeliest_s;
            if (best.since.earliest_s < likeliest_s && likeliest_s <= best.since.latest_s)
                votes[likeliest_s] += 1;
        }
        cluster.since.likeliest_s =
            std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second; })->first;
        for (auto k = best.places.rbegin(); k != best.places.rend(); ++k)
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(*k));
        clusters.push_back(std::move(cluster));
    }
    return clusters;
}

Dates dates_of(const std::vector<FleetResult>& results, const UnitFindings& unit, const Change& change) {
    return {time_s_of(results, unit.series, change.earliest - 1),
            time_s_of(results, unit.series, change.first), time_s_of(results, unit.series, change.latest)};
}

double overlap(std::vector<std::size_t> a, std::vector<std::size_t> b) {
    std::ranges::sort(a);
    std::ranges::sort(b);
    std::vector<std::size_t> both;
    std::ranges::set_intersection(a, b, std::back_inserter(both));
    const double either = static_cast<double>(a.size() + b.size() - both.size());
    return either > 0.0 ? static_cast<double>(both.size()) / either : 0.0;
}

}  // namespace fidservo::fleet
