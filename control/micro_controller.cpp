// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/micro_controller.h"

#include "core/micro_parameters.h"

#include <algorithm>
#include <cmath>

namespace fidservo::control {

namespace {

constexpr double slope_step_degC = 0.05;

/// Platform position of the model after a monotonic move from the start to a temperature.
double reference_position_mm(const MicroControllerParams& params, const MicroControllerState& state,
                             double temp_degC) {
    return params.model.stroke_scale * preisach_peek(*params.model.fod, state.start_wire, temp_degC);
}

/// Temperature at which the model, from the start of the move, reaches a platform position; not behind the
/// start, nor beyond the table.
double temperature_at(const MicroControllerParams& params, const MicroControllerState& state,
                      double position_mm) {
    const PreisachMemory& wire = state.start_wire;
    const double contraction_mm = position_mm / params.model.stroke_scale;
    if (state.up ? contraction_mm <= wire.contraction_mm : contraction_mm >= wire.contraction_mm)
        return wire.temp_degC;
    const double end_degC = state.up ? params.model.fod->high_degC() : state.heater.ambient_degC;
    return preisach_inverse(*params.model.fod, wire, contraction_mm).value_or(end_degC);
}

/// Fastest change of the reference, degC/s, in the direction of the move.
double rate_limit_degC_per_s(const MicroControllerParams& params, const MicroControllerState& state) {
    const HeaterParameters& heater = state.heater;
    const double temp_degC = state.reference_degC;
    const double rise_degC = temp_degC - heater.ambient_degC;
    const double authority = params.shaping.authority;
    if (!state.up) return -authority * rise_degC / heater.cooling_tau_s;
    return std::max(
        0.0, (authority * heater_rise_degC(heater, params.pi.high_V) - rise_degC) / heater.heating_tau_s);
}

/// Moves the temperature reference one tick on; @return its rate in degC/s.
double advance_reference(const MicroControllerParams& params, MicroControllerState& state) {
    const MicroShaping& shaping = params.shaping;
    const double tau_s = state.fine ? shaping.fine_landing_tau_s : shaping.landing_tau_s;
    const double landing = (state.goal_degC - state.reference_degC) / tau_s;
    const double limit = rate_limit_degC_per_s(params, state);
    const double rate = state.up ? std::clamp(landing, 0.0, limit) : std::clamp(landing, limit, 0.0);
    state.reference_degC += params.tick_s * rate;
    return rate;
}

/// Corrects the temperature reference by what the sensor sees, as far as the branch is steep enough to tell.
void observe(const MicroControllerParams& params, MicroControllerState& state) {
    const MicroShaping& shaping = params.shaping;
    const double before_mm = reference_position_mm(params, state, state.reference_degC);
    const double ahead_degC = state.up ? slope_step_degC : -slope_step_degC;
    const double slope =
        (reference_position_mm(params, state, state.reference_degC + ahead_degC) - before_mm) / ahead_degC;
    const double gain = shaping.observer_gain * slope /
                        (slope * slope + shaping.flat_slope_mm_per_degC * shaping.flat_slope_mm_per_degC);
    const double predicted_degC = state.reference_degC;
    const double corrected_degC = predicted_degC + gain * (state.position_mm - before_mm);
    const double start_degC = state.start_wire.temp_degC;
    state.reference_degC =
        state.up ? std::max(corrected_degC, start_degC) : std::min(corrected_degC, start_degC);
    state.surprise_degC += state.reference_degC - predicted_degC;
    state.reference_mm = reference_position_mm(params, state, state.reference_degC);
    state.deviation_mm +=
        params.tick_s / shaping.filter_tau_s * (state.position_mm - state.reference_mm - state.deviation_mm);
}

/// The reference aims beyond the target, and beyond what the rig is seen to lag or lead the model by.
void aim(const MicroControllerParams& params, MicroControllerState& state) {
    const double overreach_mm = state.fine ? params.shaping.fine_overreach_mm : params.shaping.overreach_mm;
    const double beyond_mm = state.up ? overreach_mm : -overreach_mm;
    state.goal_degC = temperature_at(params, state, state.target_mm + beyond_mm - state.deviation_mm);
}

/// A wire that was held at rest and turns out warmer or colder than believed: so is the room.
void learn_ambient(const MicroControllerParams& params, MicroControllerState& state) {
    const double step_degC = params.shaping.ambient_learning * state.surprise_degC;
    state.heater.ambient_degC +=
        std::clamp(step_degC, -params.shaping.ambient_step_degC, params.shaping.ambient_step_degC);
}

void enter_hold(const MicroControllerParams& params, MicroControllerState& state, MicroPhase phase) {
    learn_ambient(params, state);
    state.wire = state.start_wire;
    preisach_step(*params.model.fod, state.wire, state.reference_degC);
    const double start_degC = state.start_wire.temp_degC;
    const double hold_degC = state.up
                                 ? std::max(state.reference_degC - params.shaping.hold_back_degC, start_degC)
                                 : std::min(state.reference_degC + params.shaping.hold_back_degC, start_degC);
    state.hold_V =
        std::clamp(heater_command_V(state.heater, hold_degC, 0.0), params.pi.low_V, params.pi.high_V);
    state.phase = phase;
}

double approach(const MicroControllerParams& params, MicroControllerState& state) {
    observe(params, state);
    const double reached_mm = state.reference_mm + state.deviation_mm;
    state.elapsed_s += params.tick_s;
    if (state.up ? reached_mm >= state.target_mm : reached_mm <= state.target_mm) {
        enter_hold(params, state, MicroPhase::hold);
        return state.hold_V;
    }
    if (state.elapsed_s > params.shaping.timeout_s) {
        enter_hold(params, state, MicroPhase::failed);
        return state.hold_V;
    }
    aim(params, state);
    const double rate = advance_reference(params, state);
    const double feedforward_V = heater_command_V(state.heater, state.reference_degC, rate);
    return pi_update(params.pi, params.tick_s, state.pi, state.reference_mm - state.position_mm,
                     feedforward_V);
}

double command(const MicroControllerParams& params, MicroControllerState& state) {
    switch (state.phase) {
        case MicroPhase::off:
            return 0.0;
        case MicroPhase::open_loop:
            return state.command_V;
        case MicroPhase::approach:
            return approach(params, state);
        case MicroPhase::hold:
        case MicroPhase::failed:
            return state.hold_V;
    }
    return 0.0;
}

}  // namespace

MicroControllerState micro_start(const MicroControllerParams& params) {
    MicroControllerState state;
    state.wire = preisach_start(*params.model.fod, params.model.heater.ambient_degC);
    state.start_wire = state.wire;
    state.heater = params.model.heater;
    return state;
}

void micro_begin_move(const MicroControllerParams& params, MicroControllerState& state, double target_mm) {
    const MicroShaping& shaping = params.shaping;
    state.phase = MicroPhase::approach;
    state.target_mm = target_mm;
    state.up = target_mm >= state.average_mm;
    state.fine = std::abs(target_mm - state.average_mm) < shaping.fine_move_mm;
    state.start_wire = state.wire;
    state.reference_degC = state.wire.temp_degC;
    state.reference_mm = params.model.stroke_scale * state.wire.contraction_mm;
    state.deviation_mm = state.average_mm - state.reference_mm;
    aim(params, state);
    state.pi = {0.0};
    state.elapsed_s = 0.0;
    state.surprise_degC = 0.0;
}

void micro_switch_off(MicroControllerState& state) {
    state.phase = MicroPhase::off;
}

void micro_open_loop(MicroControllerState& state, double command_V) {
    state.phase = MicroPhase::open_loop;
    state.command_V = command_V;
}

double micro_update(const MicroControllerParams& params, MicroControllerState& state, double hall_adc) {
    constexpr double average_tau_s = 0.020;
    state.position_mm = platform_position_mm(params.model, hall_adc);
    const bool moving = state.phase == MicroPhase::approach;
    const double share = moving ? 1.0 : std::min(1.0, params.tick_s / average_tau_s);
    state.average_mm += share * (state.position_mm - state.average_mm);
    state.command_V = command(params, state);
    if (state.phase != MicroPhase::approach) {
        const double temp_degC =
            heater_step_degC(state.heater, state.wire.temp_degC, state.command_V, params.tick_s);
        preisach_step(*params.model.fod, state.wire, temp_degC);
    }
    return state.command_V;
}

}  // namespace fidservo::control
