// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/series.h"

#include "core/median.h"
#include "gap/fit/gap_size.h"
#include "plant/effects/catalogue.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace fidservo::fleet {
namespace {

constexpr double seconds_a_week = 7.0 * 86'400.0, credible = 0.5;

double usual_size(const plant::EffectParameter& parameter) {
    return std::abs(parameter.usual() - parameter.vanishing);
}

const NamedParameter* find_parameter(const NamedEffect& effect, std::string_view name) {
    const auto found = std::ranges::find(effect.parameters, name, &NamedParameter::name);
    return found == effect.parameters.end() ? nullptr : &*found;
}

/// f / |z|; NaN where the name does not say.
double floors_of_usual(const plant::Effect& effect, const NamedEffect& named) {
    double squares = 0.0;
    for (const plant::EffectParameter& parameter : effect.parameters)
        if (const NamedParameter* value = find_parameter(named, parameter.name); value && parameter.is_size())
            squares += std::pow((value->value - parameter.vanishing) / usual_size(parameter), 2);
    const double floors = std::sqrt(named.gap_alone * named.gap_alone - 1.0);
    return squares > 0.0 && floors > 0.0 ? floors / std::sqrt(squares) : std::nan("");
}

/// What results say of an effect.
enum class Saying { named, absent, nothing };

Saying saying_of(const FleetResult& result, std::string_view effect, const NamedEffect*& named) {
    if (!result.done) return Saying::nothing;
    for (const NamedEffect& one : result.effects) {
        if (one.effect == effect) {
            named = &one;
            return one.probability >= credible ? Saying::named : Saying::nothing;
        }
        if (std::ranges::find(one.indistinguishable_from, effect) != one.indistinguishable_from.end())
            return Saying::nothing;
    }
    const auto tried = std::ranges::find(result.tried, effect, &TriedAlone::effect);
    const bool would_be_named =
        tried != result.tried.end() && tried->would_show && result.ended == "finished";
    return would_be_named ? Saying::absent : Saying::nothing;
}

/// The size below which a diagnosis names nothing, floors.
double limit_of(double gap_after) {
    const double least = std::max(gap::least_floors, gap_after);
    return std::sqrt(least * least - 1.0);
}

std::optional<Point> point_of(const Quantity& quantity, const FleetResult& result, double usual_std) {
    const NamedEffect* named = nullptr;
    const double time = result.recorded_at_s ? weeks_of(*result.recorded_at_s) : 0.0;
    switch (saying_of(result, quantity.effect, named)) {
        case Saying::named: {
            const NamedParameter* parameter = find_parameter(*named, quantity.parameter);
            if (parameter == nullptr || !std::isfinite(parameter->value)) return {};
            const double std = parameter->std * quantity.floors_per_unit;
            return Point{time, quantity.in_floors(parameter->value), std > 0.0 ? std : usual_std};
        }
        case Saying::absent:
            return Point{time, 0.0, usual_std, limit_of(result.gap_after)};
        case Saying::nothing:
            break;
    }
    return {};
}

/// The quantity's median standard error in floors, for a value at a bound and for what is not named, which
/// have none.
double usual_std_of(const Quantity& quantity, const std::vector<const NamedEffect*>& names) {
    std::vector<double> stds;
    for (const NamedEffect* named : names)
        if (const NamedParameter* parameter = find_parameter(*named, quantity.parameter);
            parameter != nullptr && parameter->std > 0.0)
            stds.push_back(parameter->std * quantity.floors_per_unit);
    return stds.empty() ? limit_of(gap::least_floors) / std::numbers::sqrt3 : median_of(stds);
}

QuantityOverFleet over_fleet(const Quantity& quantity, const std::vector<FleetResult>& results,
                             const std::vector<UnitHistory>& units, double usual_std) {
    QuantityOverFleet fleet{quantity, {}};
    for (std::size_t u = 0; u < units.size(); ++u) {
        QuantitySeries series{.unit = u, .points = {}, .results = {}};
        for (std::size_t k = units[u].first_judged; k < units[u].results.size(); ++k) {
            const std::size_t r = units[u].results[k];
            const std::optional<Point> point = point_of(quantity, results[r], usual_std);
            if (!point) continue;
            if (!results[r].recorded_at_s) series.untimed += 1;
            series.points.push_back(*point);
            series.results.push_back(r);
        }
        if (!series.points.empty()) fleet.units.push_back(std::move(series));
    }
    return fleet;
}

}  // namespace

std::vector<UnitHistory> histories(const std::vector<FleetResult>& results) {
    std::map<std::string, std::vector<std::size_t>> by_name;
    std::set<std::pair<std::string_view, std::string_view>> seen;
    for (std::size_t r = 0; r < results.size(); ++r)
        if (!results[r].done || results[r].campaign_content.empty() ||
            seen.emplace(results[r].campaign_content, results[r].rig_content).second)
            by_name[results[r].unit.value_or(results[r].campaign)].push_back(r);
    std::vector<UnitHistory> units;
    for (auto& [name, of_unit] : by_name) {
        std::ranges::stable_sort(of_unit, {}, [&](std::size_t r) { return results[r].recorded_at_s; });
        UnitHistory unit{name, std::move(of_unit)};
        unit.first_judged = unit.results.size() - 1;
        const std::string& rig = rig_file_of(results, unit);
        while (unit.first_judged > 0 && results[unit.results[unit.first_judged - 1]].rig_content == rig)
            unit.first_judged -= 1;
        units.push_back(std::move(unit));
    }
    return units;
}

const std::string& rig_file_of(const std::vector<FleetResult>& results, const UnitHistory& unit) {
    return results[unit.results.back()].rig_content;
}

std::vector<QuantityOverFleet> quantities_over_fleet(const std::vector<FleetResult>& results,
                                                     const std::vector<UnitHistory>& units) {
    std::map<std::string_view, std::vector<const NamedEffect*>> names;
    for (const FleetResult& result : results)
        for (const NamedEffect& named : result.effects)
            if (named.probability >= credible) names[named.effect].push_back(&named);
    std::vector<QuantityOverFleet> all;
    for (const plant::Effect* effect : plant::effect_catalogue()) {
        const auto found = names.find(effect->name);
        if (found == names.end()) continue;
        std::vector<double> floors;
        for (const NamedEffect* named : found->second)
            if (const double of_usual = floors_of_usual(*effect, *named); std::isfinite(of_usual))
                floors.push_back(of_usual);
        if (floors.empty()) continue;
        for (const plant::EffectParameter& parameter : effect->parameters) {
            if (!parameter.is_size()) continue;
            const Quantity quantity{.effect = std::string(effect->name),
                                    .parameter = std::string(parameter.name),
                                    .unit = std::string(parameter.unit),
                                    .block = std::string(effect->block),
                                    .vanishing = parameter.vanishing,
                                    .floors_per_unit = median_of(floors) / usual_size(parameter)};
            all.push_back(over_fleet(quantity, results, units, usual_std_of(quantity, found->second)));
        }
    }
    return all;
}

std::vector<std::string> named_but_not_judged(const std::vector<FleetResult>& results) {
    std::map<std::string, std::set<std::string>> units_by_effect;
    for (const FleetResult& result : results)
        for (const NamedEffect& named : result.effects)
            if (named.probability >= credible && plant::find_effect(named.effect) == nullptr)
                units_by_effect[named.effect].insert(result.unit.value_or(result.campaign));
    std::vector<std::string> lines;
    lines.reserve(units_by_effect.size());
    for (const auto& [effect, units] : units_by_effect)
        lines.push_back(
            fmt::format("{}: named in {} {}; an effect that the catalogue lacks is not judged over "
                        "the fleet: see the single diagnoses",
                        effect, units.size(), units.size() == 1 ? "unit" : "units"));
    return lines;
}

std::size_t quantities_looked_at() {
    std::size_t count = 0;
    for (const plant::Effect* effect : plant::effect_catalogue())
        count += static_cast<std::size_t>(
            std::ranges::count_if(effect->parameters, &plant::EffectParameter::is_size));
    return count;
}

std::int64_t time_s_of(const std::vector<FleetResult>& results, const QuantitySeries& series,
                       std::size_t timed) {
    return *results[series.results[series.untimed + timed]].recorded_at_s;
}

double weeks_of(std::int64_t time_s) {
    return static_cast<double>(time_s) / seconds_a_week;
}

double looks_a_year(const std::vector<FleetResult>& results, const std::vector<UnitHistory>& units) {
    constexpr double weeks_a_year = 365.25 / 7.0, usual = 52.0;
    std::vector<double> between;
    for (const UnitHistory& unit : units)
        for (std::size_t k = 1; k < unit.results.size(); ++k) {
            const auto before = results[unit.results[k - 1]].recorded_at_s;
            const auto after = results[unit.results[k]].recorded_at_s;
            if (before && after && *after > *before) between.push_back(weeks_of(*after) - weeks_of(*before));
        }
    return between.empty() ? usual : weeks_a_year / median_of(between);
}

}  // namespace fidservo::fleet
