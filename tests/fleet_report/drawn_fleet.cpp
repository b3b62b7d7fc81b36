// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fleet_report/drawn_fleet.h"

#include "plant/effects/catalogue.h"

#include <cmath>
#include <random>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fidservo::fleet {

const std::vector<DrawnEffect>& drawn_effects() {
    static const std::vector<DrawnEffect> effects{
        {"drive_gain", "macro.drive", "factor", "", 1.0, 0.004},
        {"backlash", "macro.mechanics", "width_um", "um", 0.0, 30.0},
        {"viscous_friction", "macro.friction", "damping_V_s_per_mm", "V s/mm", 0.0, 0.00004},
        {"ambient_temperature", "micro.heater", "shift_degC", "degC", 0.0, 0.4},
        {"hall_gain", "micro.hall", "factor", "", 1.0, 0.003},
        {"camera_rotation", "camera.geometry", "angle_deg", "deg", 0.0, 0.05}};
    return effects;
}

std::vector<FleetResult> draw(const DrawnFleet& fleet) {
    constexpr std::int64_t first_monday_s = 1'772'409'600, week_s = 7 * 86'400;
    constexpr double least_seen_floors = 0.458257569;  // sqrt(1.1^2 - 1)
    std::mt19937_64 generator(fleet.seed);
    std::normal_distribution<double> normal;
    const std::vector<DrawnEffect>& effects = drawn_effects();
    std::vector<std::vector<double>> own(fleet.units, std::vector<double>(effects.size()));
    for (auto& unit : own)
        for (double& value : unit) value = fleet.spread_floors * normal(generator);
    std::vector<FleetResult> results;
    for (std::size_t week = 0; week < fleet.weeks; ++week)
        for (std::size_t unit = 0; unit < fleet.units; ++unit) {
            FleetResult result;
            result.file = fmt::format("u{:04}-w{:03}.json", unit, week);
            result.campaign = fmt::format("week-{:03}/unit-{:04}", week, unit);
            result.campaign_content = fmt::format("{:064x}", week * 100'000 + unit);
            result.unit = fmt::format("P-{:04}", unit + 1);
            result.recorded_at_s = first_monday_s + static_cast<std::int64_t>(week) * week_s + 28'800;
            result.labels["batch"] = fmt::format("{}", unit % fleet.batches + 1);
            result.rig_name = "reference";
            result.rig_content = std::string(64, 'a');
            result.program = "0.0.0";
            result.effort = 20.0;
            result.done = true;
            result.ended = "finished";
            double squares = 0.0;
            for (std::size_t e = 0; e < effects.size(); ++e) {
                const double size = own[unit][e] + fleet.truth(e, unit, week) +
                                    fleet.scatter_floors * normal(generator) +
                                    fleet.std_floors * normal(generator);
                if (std::abs(size) < least_seen_floors) continue;
                squares += size * size;
                result.effects.push_back({.effect = effects[e].effect,
                                          .block = effects[e].block,
                                          .probability = 0.97,
                                          .gap_removed = 0.99,
                                          .gap_alone = std::sqrt(1.0 + size * size),
                                          .parameters = {{effects[e].parameter, effects[e].unit,
                                                          effects[e].vanishing + size * effects[e].per_floor,
                                                          fleet.std_floors * effects[e].per_floor}},
                                          .indistinguishable_from = {}});
                result.blocks.push_back({effects[e].block, 0.97});
            }
            result.gap_before = std::sqrt(1.0 + squares);
            result.gap_after = 1.0;
            result.verdict = result.effects.empty() ? "no-gap" : "explained";
            result.signals = {{"encoder", "count", 0.3 * result.gap_before, 0.3, 0.3}};
            for (const plant::Effect* effect : plant::effect_catalogue())
                result.tried.push_back({std::string(effect->name), 0.01, 0.1});
            results.push_back(std::move(result));
        }
    return results;
}

std::string file_text(const FleetResult& result) {
    using Json = nlohmann::ordered_json;
    Json effects = Json::array(), tried = Json::array(), signals = Json::array(), where = Json::array();
    for (const NamedEffect& effect : result.effects) {
        Json parameters = Json::array();
        for (const NamedParameter& parameter : effect.parameters)
            parameters.push_back({{"name", parameter.name},
                                  {"value", parameter.value},
                                  {"unit", parameter.unit},
                                  {"std", parameter.std}});
        effects.push_back({{"effect", effect.effect},
                           {"block", effect.block},
                           {"probability", effect.probability},
                           {"support", {{"gap_alone", effect.gap_alone}}},
                           {"parameters", parameters},
                           {"indistinguishable_from", effect.indistinguishable_from},
                           {"gap_removed", effect.gap_removed},
                           {"gap_removed_interval", {0.9, 1.0}}});
    }
    for (const TriedAlone& one : result.tried)
        tried.push_back({{"effect", one.effect},
                         {"probability", one.probability},
                         {"gap_removed", one.gap_removed},
                         {"would_show", one.would_show}});
    for (const SignalSize& signal : result.signals)
        signals.push_back({{"signal", signal.signal},
                           {"unit", signal.unit},
                           {"before", signal.before},
                           {"after", signal.after},
                           {"floor", signal.floor}});
    for (const AccusedBlock& block : result.blocks)
        where.push_back({{"block", block.block}, {"probability", block.probability}});
    Json recorded_at, unit;
    if (result.recorded_at_s) recorded_at = date_of(*result.recorded_at_s) + "T08:00:00Z";
    if (result.unit) unit = *result.unit;
    Json json{{"format", "fidservo-fleet-result/1"},
              {"task",
               {{"kind", "diagnose"},
                {"campaign", result.campaign},
                {"content", result.campaign_content},
                {"unit", unit},
                {"recorded_at", recorded_at},
                {"labels", result.labels}}},
              {"rig", {{"name", result.rig_name}, {"content", result.rig_content}}},
              {"program", result.program},
              {"effort", result.effort},
              {"status", result.done ? "done" : "failed"}};
    if (!result.done) {
        json["reason"] = result.reason;
        return json.dump(2) + "\n";
    }
    json["diagnosis"] = {
        {"format", "fidservo-diagnosis/1"},
        {"verdict", result.verdict},
        {"ended", result.ended},
        {"signals", signals},
        {"where", where},
        {"effects", effects},
        {"candidates", tried},
        {"gap",
         {{"before", result.gap_before}, {"after", result.gap_after}, {"floor", 1.0}, {"removed", 1.0}}},
        {"unexplained", nullptr},
        {"next_experiment", nullptr},
        {"notes", Json::array()}};
    return json.dump(2) + "\n";
}

}  // namespace fidservo::fleet
