// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/fleet_json.h"

#include "src/fleet/report/judgement_words.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fidservo::fleet {
namespace {

using FleetJson = nlohmann::ordered_json;

FleetJson rounded(double value) {
    if (!std::isfinite(value)) return nullptr;
    return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}

FleetJson date_json(std::optional<std::int64_t> time_s) {
    return time_s ? FleetJson(date_of(*time_s)) : FleetJson(nullptr);
}

FleetJson value_json(const Quantity& quantity, const Level& level) {
    return {{"value", rounded(quantity.in_units(level.value))},
            {"std", rounded(level.std / quantity.floors_per_unit)},
            {"floors", rounded(level.value)}};
}

FleetJson names_json(const FleetFindings& findings, const std::vector<std::size_t>& units) {
    FleetJson names = FleetJson::array();
    for (const std::size_t unit : units) names.push_back(findings.units[unit].name);
    return names;
}

FleetJson unexplained_json(const FleetFindings& findings) {
    const Unexplained& unexplained = findings.unexplained;
    if (unexplained.empty()) return nullptr;
    FleetJson units = FleetJson::array();
    for (const LeftOver& left : unexplained.units)
        units.push_back({{"unit", findings.units[left.unit].name},
                         {"floors", rounded(left.floors)},
                         {"before", rounded(left.before)},
                         {"block", left.block.empty() ? FleetJson(nullptr) : FleetJson(left.block)},
                         {"campaign", left.campaign}});
    return {{"whose", unexplained.is_of_all() ? "all" : "units"},
            {"units", units},
            {"text", unexplained_sentence(unexplained)},
            {"to_do", what_to_do(unexplained)}};
}

FleetJson units_json(const std::vector<FleetResult>& results, const FleetFindings& findings) {
    FleetJson units = FleetJson::array();
    for (std::size_t u = 0; u < findings.units.size(); ++u) {
        const UnitHistory& unit = findings.units[u];
        const FleetResult& last = results[unit.results.back()];
        FleetJson about = FleetJson::array();
        for (std::size_t j = 0; j < findings.judgements.size(); ++j)
            if (std::ranges::find(findings.judgements[j].units, u) != findings.judgements[j].units.end())
                about.push_back(j);
        units.push_back({{"unit", unit.name},
                         {"labels", last.labels},
                         {"results", unit.results.size()},
                         {"judged", unit.results.size() - unit.first_judged},
                         {"last", date_json(last.recorded_at_s)},
                         {"status", last.done ? "done" : "failed"},
                         {"verdict", last.verdict},
                         {"gap_before", rounded(last.done ? last.gap_before : std::nan(""))},
                         {"gap_after", rounded(last.done ? last.gap_after : std::nan(""))},
                         {"judgements", about}});
    }
    return units;
}

FleetJson effect_json(const FleetFindings& findings, const QuantityFindings& found) {
    FleetJson units = FleetJson::array();
    for (const UnitFindings& unit : found.units)
        units.push_back({{"unit", findings.units[unit.series.unit].name},
                         {"diagnoses", unit.series.points.size()},
                         {"named", std::ranges::count_if(unit.series.points, &Point::named)},
                         {"own", value_json(found.quantity, unit.level)},
                         {"pooled", value_json(found.quantity, unit.pooled)}});
    return {{"effect", found.quantity.effect},
            {"parameter", found.quantity.parameter},
            {"unit", found.quantity.unit},
            {"block", found.quantity.block},
            {"rig_file_value", rounded(found.quantity.vanishing)},
            {"floors_per_unit", rounded(found.quantity.floors_per_unit)},
            {"population",
             {{"mean", value_json(found.quantity, {found.population.mean, found.population.mean_std})},
              {"spread_floors", rounded(found.population.spread)}}},
            {"scatter_floors", rounded(found.scatter.std)},
            {"units", units}};
}

FleetJson judgement_json(const FleetFindings& findings, const Judgement& judgement) {
    const Quantity& quantity = findings.quantities[judgement.quantity].quantity;
    FleetJson since = nullptr;
    if (judgement.since)
        since = {{"date", date_of(judgement.since->likeliest_s)},
                 {"after", date_of(judgement.since->earliest_s)},
                 {"by", date_of(judgement.since->latest_s)}};
    const double per_unit = quantity.floors_per_unit;
    return {{"whose", name_of(judgement.whose)},
            {"matter", name_of(judgement.matter)},
            {"group", judgement.group},
            {"units", names_json(findings, judgement.units)},
            {"effect", quantity.effect},
            {"block", quantity.block},
            {"parameter", quantity.parameter},
            {"unit", quantity.unit},
            {judgement.matter == Matter::trend ? "change_a_week" : "change",
             rounded(judgement.size.value / per_unit)},
            {"std", rounded(judgement.size.std / per_unit)},
            {"floors", rounded(judgement.size.value)},
            {"now", rounded(quantity.in_units(judgement.now))},
            {"since", since},
            {"found", date_json(judgement.found_s)},
            {"probability", rounded(judgement.probability)},
            {"log_odds", rounded(judgement.log_odds)},
            {"log_likelihood_ratios",
             {{"all", rounded(judgement.log_all)},
              {"group", rounded(judgement.log_group)},
              {"unit", rounded(judgement.log_unit)}}},
            {"text", whose_words(findings, judgement) + ". " + matter_sentence(findings, judgement)},
            {"evidence", evidence_sentences(findings, judgement)},
            {"to_do", what_to_do(findings, judgement)}};
}

}  // namespace

std::string fleet_json(const Collected& collected, const FleetFindings& findings,
                       const std::filesystem::path& cured) {
    FleetJson effects = FleetJson::array(), judgements = FleetJson::array(), failed = FleetJson::array();
    for (const QuantityFindings& found : findings.quantities) effects.push_back(effect_json(findings, found));
    for (const Judgement& judgement : findings.judgements)
        judgements.push_back(judgement_json(findings, judgement));
    for (const FleetResult& result : collected.results)
        if (!result.done) failed.push_back({{"campaign", result.campaign}, {"reason", result.reason}});
    const FleetJson all{{"format", "fidservo-fleet/1"},
                        {"results", collected.results.size()},
                        {"failed", failed},
                        {"damaged", collected.damaged},
                        {"false_alarms_a_unit_year", false_alarms_a_unit_year},
                        {"quantities_looked_at", quantities_looked_at()},
                        {"looks_a_year", rounded(findings.looks_a_year)},
                        {"unexplained", unexplained_json(findings)},
                        {"judgements", judgements},
                        {"units", units_json(collected.results, findings)},
                        {"effects", effects},
                        {"cured_rig", cured.empty() ? FleetJson(nullptr) : FleetJson(cured.string())}};
    return all.dump(1) + "\n";
}

}  // namespace fidservo::fleet
