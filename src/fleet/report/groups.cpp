// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/groups.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
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

bool may_be_one(const OneChange& a, const OneChange& b) {
    const auto allows = [](const Dates& dates, std::int64_t time_s) {
        return dates.earliest_s < time_s && time_s <= dates.latest_s;
    };
    return a.kind == b.kind && a.up == b.up && allows(a.dates, b.dates.likeliest_s) &&
           allows(b.dates, a.dates.likeliest_s);
}

}  // namespace

std::vector<UnitGroup> groups_of(const std::vector<FleetResult>& results,
                                 const std::vector<UnitHistory>& histories,
                                 std::span<const UnitFindings> units) {
    std::map<std::pair<std::string, std::string>, UnitPlaces> by_label;
    std::map<std::int64_t, UnitPlaces> by_first_week;
    for (std::size_t place = 0; place < units.size(); ++place) {
        const std::vector<std::size_t>& of_unit = histories[units[place].series.unit].results;
        for (const auto& label : results[of_unit.back()].labels) by_label[label].push_back(place);
        const auto first = std::ranges::find_if(
            of_unit, [&](std::size_t r) { return results[r].recorded_at_s.has_value(); });
        if (first != of_unit.end()) by_first_week[monday_of(*results[*first].recorded_at_s)].push_back(place);
    }
    std::vector<UnitGroup> groups;
    for (auto& [label, places] : by_label)
        add_group(groups, units.size(), label.first + " " + label.second, std::move(places));
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
        std::vector<std::size_t> best;
        for (const OneChange& seed : left) {
            std::vector<std::size_t> with_it;
            std::set<std::size_t> seen;
            for (std::size_t k = 0; k < left.size(); ++k)
                if (may_be_one(seed, left[k]) && seen.insert(left[k].unit).second) with_it.push_back(k);
            if (with_it.size() > best.size()) best = std::move(with_it);
        }
        const OneChange& first = left[best.front()];
        ChangeCluster cluster{first.kind, {}, {}, first.dates};
        std::map<std::int64_t, int> votes;
        for (const std::size_t k : best) {
            cluster.units.push_back(left[k].unit);
            cluster.changes.push_back(left[k].change);
            votes[left[k].dates.likeliest_s] += 1;
            cluster.since.earliest_s = std::max(cluster.since.earliest_s, left[k].dates.earliest_s);
            cluster.since.latest_s = std::min(cluster.since.latest_s, left[k].dates.latest_s);
        }
        cluster.since.likeliest_s =
            std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second; })->first;
        for (auto k = best.rbegin(); k != best.rend(); ++k)
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
