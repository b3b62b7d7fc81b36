// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/micro_stage.h"

#include "core/demand.h"
#include "core/micro_model.h"
#include "core/rig.h"

#include <algorithm>
#include <cmath>

namespace fidservo::plant {

namespace {

HallSight hall_sight(const MicroStage& stage, const MicroStageState& state) {
    return {seconds(state.time_ns), state.position_mm, state.heater.temp_degC,
            stage.heater.parameters.ambient_degC, state.formulas.carriage};
}

double hall_disturbance_V(const MicroStage& stage, const MicroStageState& state) {
    const HallDisturbance& disturbance = stage.hall_disturbance;
    const double by_formulas_V = stage.formulas.act(Port::hall_voltage)
                                     ? formula_hall_V(stage.formulas, hall_sight(stage, state))
                                     : 0.0;
    if (disturbance.is_none()) return by_formulas_V;
    return disturbance.drift_V(seconds(state.time_ns)) + disturbance.leak_V_per_V * state.drive_V +
           by_formulas_V;
}

using MicroVariables = std::array<double, micro_variable::count>;

/// What the Hall sensor's formulas know of them; the others are 0.
MicroVariables formula_variables(const HallSight& seen) {
    using namespace micro_variable;
    MicroVariables variables{};
    variables[time] = seen.time_s;
    variables[wire_temp] = seen.wire_degC;
    variables[room_temp] = seen.room_degC;
    variables[platform] = seen.platform_mm;
    variables[place] = seen.carriage.place_mm;
    variables[speed] = seen.carriage.speed_mm_per_s;
    variables[acceleration] = seen.carriage.shaking.acceleration_mm_per_s2;
    variables[drive] = seen.carriage.drive_V;
    return variables;
}

MicroVariables formula_variables(const MicroStage& stage, const MicroStageState& state) {
    using namespace micro_variable;
    const MicroFormulaState& seen = state.formulas;
    MicroVariables variables = formula_variables(hall_sight(stage, state));
    variables[heater_command] = seen.command_V;
    variables[heater_power] = heater_rise_degC(stage.heater.parameters, seen.command_V);
    variables[contraction] = seen.wire_mm;
    variables[contraction_rate] = seen.contraction_mm_per_s;
    return variables;
}

/// What formulas add at a port; 0 where none acts.
double added(const MicroStage& stage, const MicroStageState& state, Port port) {
    return stage.formulas.act(port)
               ? stage.formulas.value(port, formula_variables(stage, state), state.formulas.memory)
               : 0.0;
}

/// What formulas remember where all has been as it is for long.
void remember(const MicroStage& stage, MicroStageState& state) {
    if (stage.formulas.remember())
        state.formulas.memory = stage.formulas.start(formula_variables(stage, state), seconds(stage.tick_ns));
}

/// Where formulas leave the temperature of a wire that has stood unheated for long; the room's where they let
/// it come to no end.
double settled_degC(const MicroStage& stage, MicroStageState state) {
    const HeaterParameters& heater = stage.heater.parameters;
    constexpr int most_rounds = 200;
    constexpr double level_degC = 1e-9, share = 0.5;
    for (int round = 0; round < most_rounds; ++round) {
        const double flow_degC_per_s = added(stage, state, Port::heat_flow);
        const double tau_s = flow_degC_per_s > 0.0 ? heater.cooling_tau_s : heater.heating_tau_s;
        const double change_degC = heater.ambient_degC + added(stage, state, Port::heater_power) +
                                   tau_s * flow_degC_per_s - state.heater.temp_degC;
        if (std::abs(change_degC) < level_degC) return state.heater.temp_degC;
        state.heater.temp_degC += share * change_degC;
        remember(stage, state);
    }
    return heater.ambient_degC;
}

}  // namespace

std::optional<MicroStageParameters> micro_stage_parameters(const Rig& rig) {
    if (!rig.micro) return std::nullopt;
    return MicroStageParameters{.heater = rig.micro->heater, .fod = rig.micro->fod, .hall = rig.micro->hall};
}

MicroStage make_micro_stage(const MicroStageParameters& parameters, double tick_s) {
    FIDSERVO_DEMAND(parameters.fod != nullptr);
    MicroStage stage{make_heater(parameters.heater, tick_s, parameters.mass, parameters.heater_delay_s),
                     parameters.fod,
                     parameters.table_shift_degC,
                     parameters.table_shift_degC_per_mm,
                     parameters.stroke_factor,
                     std::nullopt,
                     make_hall_sensor(parameters.hall),
                     parameters.hall_disturbance,
                     parameters.hall_disturbance.leak_share(tick_s),
                     nanoseconds(tick_s),
                     parameters.formulas};
    if (parameters.swing.gain != 0.0) stage.swing = make_platform_swing(parameters.swing, tick_s);
    return stage;
}

MicroStageState start(const MicroStage& stage, std::uint64_t seed) {
    const double extended_degC = stage.heater.parameters.ambient_degC - stage.table_shift_degC;
    MicroStageState state{
        start(stage.heater), preisach_start(*stage.fod, extended_degC), 0.0, {seed, "hall"}};
    state.position_mm = stage.stroke_factor * state.wire.contraction_mm;
    if (!stage.formulas.any()) return state;
    state.formulas.wire_mm = state.position_mm;
    remember(stage, state);
    if (stage.formulas.act(Port::heater_power) || stage.formulas.act(Port::heat_flow)) {
        state.heater.temp_degC = settled_degC(stage, state);
        remember(stage, state);
    }
    const bool begins_elsewhere = state.heater.temp_degC != stage.heater.parameters.ambient_degC;
    if (stage.formulas.act(Port::transformation) || begins_elsewhere) {
        state.wire = preisach_start(*stage.fod, table_degC(stage, state));
        state.formulas.wire_mm = stage.stroke_factor * state.wire.contraction_mm;
    }
    state.formulas.beside_mm = added(stage, state, Port::platform);
    state.position_mm = held_mm(stage, state) + state.formulas.beside_mm;
    return state;
}

double table_degC(const MicroStage& stage, const MicroStageState& state) {
    const double contraction_mm = stage.stroke_factor * state.wire.contraction_mm;
    return state.heater.temp_degC - stage.table_shift_degC - stage.table_shift_degC_per_mm * contraction_mm -
           added(stage, state, Port::transformation);
}

double held_mm(const MicroStage& stage, const MicroStageState& state) {
    return stage.stroke_factor * state.wire.contraction_mm + added(stage, state, Port::contraction);
}

double formula_hall_V(const Formulas& formulas, const HallSight& seen) {
    return formulas.value(Port::hall_voltage, formula_variables(seen), {});
}

double mean_reading_lsb(const MicroStage& stage, const MicroStageState& state) {
    return mean_reading_lsb(stage.hall, state.position_mm) +
           hall_disturbance_V(stage, state) * stage.hall.lsb_per_V;
}

int sample(const MicroStage& stage, MicroStageState& state) {
    return sample(stage.hall, state.hall_noise, state.position_mm, hall_disturbance_V(stage, state));
}

void advance(const MicroStage& stage, MicroStageState& state, double command_V,
             const CarriageInfluence& carriage) {
    const double tick_s = stage.heater.tick_s;
    ExtraHeat extra;
    if (stage.formulas.any()) {
        state.formulas.command_V = command_V;
        state.formulas.carriage = carriage;
        if (stage.formulas.remember())
            stage.formulas.begin_tick(state.formulas.memory, formula_variables(stage, state), tick_s);
        extra = {added(stage, state, Port::heater_power), added(stage, state, Port::heat_flow)};
    }
    advance(stage.heater, state.heater, command_V, extra);
    const double wire_mm =
        stage.stroke_factor * preisach_step(*stage.fod, state.wire, table_degC(stage, state));
    state.position_mm = wire_mm;
    if (stage.swing) {
        advance(*stage.swing, state.swing, carriage.shaking);
        state.position_mm += state.swing.position_mm;
    }
    if (stage.formulas.any()) {
        state.formulas.contraction_mm_per_s = (wire_mm - state.formulas.wire_mm) / tick_s;
        state.formulas.wire_mm = wire_mm;
        state.position_mm += added(stage, state, Port::contraction);
        state.formulas.beside_mm = added(stage, state, Port::platform);
        state.position_mm += state.formulas.beside_mm;
    }
    state.time_ns += stage.tick_ns;
    state.drive_V += stage.leak_share * (carriage.drive_V - state.drive_V);
}

}  // namespace fidservo::plant
