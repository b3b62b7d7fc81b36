// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/fleet_page_data.h"

#include "src/fleet/report/groups.h"
#include "src/report/html.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fidservo::fleet {
namespace {

using report::packed;

/// Units with something to say first, then by their last gap.
std::vector<std::size_t> order_of_units(const std::vector<FleetResult>& results,
                                        const FleetFindings& findings) {
    std::vector<double> urgency(findings.units.size(), 0.0);
    for (std::size_t u = 0; u < urgency.size(); ++u) {
        const FleetResult& last = results[findings.units[u].results.back()];
        urgency[u] = last.done ? last.gap_before : 0.0;
    }
    for (const Judgement& judgement : findings.judgements)
        if (judgement.whose != Whose::all)
            for (const std::size_t unit : judgement.units) urgency[unit] += 1e6;
    for (const LeftOver& left : findings.unexplained.units) urgency[left.unit] += 1e9;
    std::vector<std::size_t> order(urgency.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater{}, [&](std::size_t u) { return urgency[u]; });
    return order;
}

nlohmann::json heat_json(const std::vector<FleetResult>& results, const FleetFindings& findings,
                         const std::vector<std::size_t>& order) {
    std::vector<double> rows, times;
    std::vector<float> gaps;
    for (std::size_t row = 0; row < order.size(); ++row)
        for (const std::size_t r : findings.units[order[row]].results) {
            if (!results[r].recorded_at_s) continue;
            rows.push_back(static_cast<double>(row));
            times.push_back(static_cast<double>(*results[r].recorded_at_s));
            gaps.push_back(results[r].done ? static_cast<float>(results[r].gap_before) : std::nanf(""));
        }
    return {{"unit", packed(rows)}, {"time", packed(times)}, {"gap", packed(gaps)}};
}

nlohmann::json effect_plot(const std::vector<FleetResult>& results, const QuantityFindings& found,
                           const std::vector<double>& row_of) {
    const Quantity& quantity = found.quantity;
    const auto in_unit = [&](double floors) { return static_cast<float>(quantity.in_units(floors)); };
    const auto width = [&](double floors) {
        return static_cast<float>(1.96 * floors / quantity.floors_per_unit);
    };
    std::vector<std::size_t> by_value(found.units.size());
    std::iota(by_value.begin(), by_value.end(), std::size_t{0});
    std::ranges::stable_sort(by_value, {}, [&](std::size_t k) { return found.units[k].pooled.value; });
    const std::vector<bool> is_odd = odd_units(found);
    std::vector<float> own, error, pooled, value, std;
    std::vector<double> units, odd, when, whose;
    nlohmann::json changed = nlohmann::json::array(), marks = nlohmann::json::array();
    for (const std::size_t k : by_value) {
        const UnitFindings& unit = found.units[k];
        own.push_back(in_unit(unit.level.value));
        error.push_back(width(unit.level.std));
        pooled.push_back(in_unit(unit.pooled.value));
        units.push_back(row_of[unit.series.unit]);
        odd.push_back(is_odd[k] ? 1.0 : 0.0);
        if (!unit.changes.empty()) changed.push_back(row_of[unit.series.unit]);
        for (const Change& change : unit.changes) {
            const Dates dates = dates_of(results, unit, change);
            marks.push_back({dates.earliest_s, dates.latest_s});
        }
        for (std::size_t p = unit.series.untimed; p < unit.series.points.size(); ++p) {
            const Point& point = unit.series.points[p];
            if (!point.named()) continue;
            when.push_back(static_cast<double>(*results[unit.series.results[p]].recorded_at_s));
            whose.push_back(row_of[unit.series.unit]);
            value.push_back(in_unit(point.value));
            std.push_back(width(point.std));
        }
    }
    return {{"own", packed(own)},
            {"error", packed(error)},
            {"pooled", packed(pooled)},
            {"units", packed(units)},
            {"odd", packed(odd)},
            {"time", packed(when)},
            {"whose", packed(whose)},
            {"value", packed(value)},
            {"std", packed(std)},
            {"changed", changed},
            {"marks", marks},
            {"unit", quantity.unit},
            {"rig", quantity.vanishing},
            {"mean", quantity.in_units(found.population.mean)},
            {"spread", std::abs(found.population.spread / quantity.floors_per_unit)}};
}

}  // namespace

std::string plot_data(const std::vector<FleetResult>& results, const FleetFindings& findings) {
    constexpr double seconds_a_year = 365.25 * 86'400.0;
    const std::vector<std::size_t> order = order_of_units(results, findings);
    std::vector<double> row_of(order.size());
    nlohmann::json names = nlohmann::json::array(), effects = nlohmann::json::array();
    for (std::size_t row = 0; row < order.size(); ++row) {
        row_of[order[row]] = static_cast<double>(row);
        names.push_back(findings.units[order[row]].name);
    }
    for (const QuantityFindings& found : findings.quantities)
        effects.push_back(effect_plot(results, found, row_of));
    std::string json = nlohmann::json({{"units", names},
                                       {"step", seconds_a_year / findings.looks_a_year},
                                       {"heat", heat_json(results, findings, order)},
                                       {"effects", effects}})
                           .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    // "</" would end the script element.
    for (std::size_t at = json.find('<'); at != std::string::npos; at = json.find('<', at))
        json.replace(at, 1, "\\u003c");
    return json;
}

}  // namespace fidservo::fleet
