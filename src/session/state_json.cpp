// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/state_json.h"

#include "core/micro_parameters.h"

#include <nlohmann/json.hpp>

namespace fidservo {

using nlohmann::json;

json json_of(const PreisachMemory& wire) {
    json loops = json::array();
    for (const PreisachLoop& loop : wire.loops)
        loops.push_back({loop.peak_degC, loop.valley_degC, loop.contraction_mm});
    return {{"loops", loops},
            {"temp_degC", wire.temp_degC},
            {"last_peak_degC", wire.last_peak_degC},
            {"contraction_mm", wire.contraction_mm}};
}

void read_json(const json& from, PreisachMemory& wire) {
    wire.loops.clear();
    for (const json& loop : from.at("loops")) wire.loops.push_back({loop.at(0), loop.at(1), loop.at(2)});
    wire.temp_degC = from.at("temp_degC");
    wire.last_peak_degC = from.at("last_peak_degC");
    wire.contraction_mm = from.at("contraction_mm");
}

json json_of(const HeaterParameters& heater) {
    return {heater.onset_V,       heater.limit_V,       heater.gain_degC_per_V,
            heater.heating_tau_s, heater.cooling_tau_s, heater.ambient_degC};
}

void read_json(const json& from, HeaterParameters& heater) {
    heater = {from.at(0), from.at(1), from.at(2), from.at(3), from.at(4), from.at(5)};
}

json json_of(const plant::DelayLineState& line) {
    json pending = json::array();
    for (const auto& change : line.pending) pending.push_back({change.given_ns, change.command});
    return {{"pending", pending},  {"first", line.first},   {"count", line.count},
            {"given", line.given}, {"acting", line.acting}, {"now_ns", line.now_ns}};
}

void read_json(const json& from, plant::DelayLineState& line) {
    line.pending.clear();
    for (const json& change : from.at("pending")) line.pending.push_back({change.at(0), change.at(1)});
    line.first = from.at("first");
    line.count = from.at("count");
    line.given = from.at("given");
    line.acting = from.at("acting");
    line.now_ns = from.at("now_ns");
}

namespace {

json json_of(const plant::FormulaMemory& memory) {
    return {{"values", memory.values},
            {"next", memory.next},
            {"past", memory.past},
            {"ticks", memory.ticks},
            {"tick_s", memory.tick_s}};
}

void read_json(const json& from, plant::FormulaMemory& memory) {
    from.at("values").get_to(memory.values);
    from.at("next").get_to(memory.next);
    from.at("past").get_to(memory.past);
    from.at("ticks").get_to(memory.ticks);
    from.at("tick_s").get_to(memory.tick_s);
}

json json_of(const plant::CarriageFormulaState& seen) {
    return {{"time_s", seen.time_s},
            {"way_mm", seen.way_mm},
            {"command_V", seen.command_V},
            {"memory", json_of(seen.memory)}};
}

void read_json(const json& from, plant::CarriageFormulaState& seen) {
    from.at("time_s").get_to(seen.time_s);
    from.at("way_mm").get_to(seen.way_mm);
    from.at("command_V").get_to(seen.command_V);
    read_json(from.at("memory"), seen.memory);
}

json json_of(const plant::MicroFormulaState& seen) {
    const plant::CarriageInfluence& carriage = seen.carriage;
    return {{"seen",
             {seen.command_V, seen.wire_mm, seen.contraction_mm_per_s, seen.beside_mm,
              carriage.shaking.acceleration_mm_per_s2, carriage.shaking.jerk_mm_per_s3, carriage.drive_V,
              carriage.place_mm, carriage.speed_mm_per_s}},
            {"memory", json_of(seen.memory)}};
}

void read_json(const json& from, plant::MicroFormulaState& seen) {
    const auto numbers = from.at("seen").get<std::array<double, 9>>();
    seen.command_V = numbers[0];
    seen.wire_mm = numbers[1];
    seen.contraction_mm_per_s = numbers[2];
    seen.beside_mm = numbers[3];
    seen.carriage = {{numbers[4], numbers[5]}, numbers[6], numbers[7], numbers[8]};
    read_json(from.at("memory"), seen.memory);
}

json json_of(const plant::MechanismState& mechanism) {
    return {mechanism.play_mm, mechanism.driven_mm_per_s, mechanism.stretch_mm, mechanism.stretching_mm_per_s,
            mechanism.bristle_bend};
}

void read_json(const json& from, plant::MechanismState& mechanism) {
    mechanism = {from.at(0), from.at(1), from.at(2), from.at(3), from.at(4)};
}

}  // namespace

json json_of(const plant::StageState& state) {
    json result{
        {"carriage_mm", state.axis.position_mm},      {"velocity_mm_per_s", state.axis.velocity_mm_per_s},
        {"mechanism", json_of(state.axis.mechanism)}, {"command_line", json_of(state.axis.delay)},
        {"formulas", json_of(state.axis.formulas)},   {"encoder_origin", state.encoder.origin_count}};
    if (state.micro) {
        result["wire_degC"] = state.micro->heater.temp_degC;
        result["mass_rise_degC"] = state.micro->heater.mass_rise_degC;
        result["heater_line"] = json_of(state.micro->heater.line);
        result["swing"] = {state.micro->swing.position_mm, state.micro->swing.velocity_mm_per_s};
        result["time_ns"] = state.micro->time_ns;
        result["drive_V"] = state.micro->drive_V;
        result["micro_formulas"] = json_of(state.micro->formulas);
        result["wire"] = json_of(state.micro->wire);
        result["platform_mm"] = state.micro->position_mm;
        result["hall_noise"] = state.micro->hall_noise.position();
    }
    return result;
}

void read_json(const json& from, plant::StageState& state) {
    state.axis.position_mm = from.at("carriage_mm");
    state.axis.velocity_mm_per_s = from.at("velocity_mm_per_s");
    read_json(from.at("mechanism"), state.axis.mechanism);
    read_json(from.at("command_line"), state.axis.delay);
    read_json(from.at("formulas"), state.axis.formulas);
    state.encoder.origin_count = from.at("encoder_origin");
    if (!state.micro) return;
    state.micro->heater.temp_degC = from.at("wire_degC");
    state.micro->heater.mass_rise_degC = from.at("mass_rise_degC");
    read_json(from.at("heater_line"), state.micro->heater.line);
    state.micro->swing = {from.at("swing").at(0), from.at("swing").at(1)};
    state.micro->time_ns = from.at("time_ns");
    state.micro->drive_V = from.at("drive_V");
    read_json(from.at("micro_formulas"), state.micro->formulas);
    read_json(from.at("wire"), state.micro->wire);
    state.micro->position_mm = from.at("platform_mm");
    state.micro->hall_noise.seek(from.at("hall_noise"));
}

json json_of(const control::PositionerState& state) {
    const control::MicroControllerState& micro = state.micro;
    return {{"count", state.macro.last_count.value_or(0)},
            {"quiet_s", state.macro.quiet_s},
            {"micro_phase", static_cast<int>(micro.phase)},
            {"wire", json_of(micro.wire)},
            {"heater", json_of(micro.heater)},
            {"command_V", micro.command_V},
            {"hold_V", micro.hold_V},
            {"position_mm", micro.position_mm},
            {"average_mm", micro.average_mm}};
}

void read_json(const json& from, control::PositionerState& state) {
    control::MicroControllerState& micro = state.micro;
    state.phase = control::PositionerPhase::idle;
    state.macro.setpoint_count.reset();
    state.macro.last_count = from.at("count").get<std::int64_t>();
    state.macro.quiet_s = from.at("quiet_s");
    micro.phase = static_cast<control::MicroPhase>(from.at("micro_phase").get<int>());
    read_json(from.at("wire"), micro.wire);
    read_json(from.at("heater"), micro.heater);
    micro.command_V = from.at("command_V");
    micro.hold_V = from.at("hold_V");
    micro.position_mm = from.at("position_mm");
    micro.average_mm = from.at("average_mm");
}

}  // namespace fidservo
