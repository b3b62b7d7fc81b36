// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/watchdog.h"

#include "core/dead_zone.h"
#include "core/micro_model.h"
#include "core/rig.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::control {

namespace {

constexpr double beside_travel = 0.1;      ///< of the platform's travel, to either side
constexpr double above_table_degC = 15.0;  ///< that the wire may be

void follow_carriage(const WatchdogParams& params, WatchdogState& state, const WatchdogInput& input) {
    const std::int64_t count = input.sample.encoder_count;
    const double moved_mm =
        static_cast<double>(count - state.last_count.value_or(count)) * params.macro.encoder_resolution_mm;
    state.last_count = count;
    const double driven = dead_zone_V(params.macro.dead_zone, input.command.macro_V) *
                          params.macro.velocity_gain_mm_per_s_per_V;
    for (int tick = 0; tick <= input.ticks_late; ++tick) {
        state.lead_mm += state.speed_mm_per_s * params.tick_s;
        state.speed_mm_per_s += (1.0 - params.macro.velocity_pole) * (driven - state.speed_mm_per_s);
    }
    state.lead_mm -= moved_mm;
    state.lead_mm *= std::exp(-(1 + input.ticks_late) * params.tick_s / params.following_tau_s);
}

bool beyond(const WatchdogParams& params, const WatchdogInput& input) {
    if (!input.travel) return false;
    const double margin_count = params.overtravel_mm / params.macro.encoder_resolution_mm;
    const auto count = static_cast<double>(input.sample.encoder_count);
    return count < input.travel->low_count - margin_count || count > input.travel->high_count + margin_count;
}

}  // namespace

WatchdogParams watchdog_params(const Rig& rig) {
    const MicroParameters& micro = rig.micro.value();
    const double beside_mm = beside_travel * (micro.high_mm - micro.low_mm);
    const double lsb_V = hall_lsb_V(micro.hall);
    WatchdogParams params{};
    params.tick_s = rig.tick_s;
    params.hall_low_adc = hall_voltage_V(micro.hall, micro.low_mm - beside_mm) / lsb_V;
    params.hall_high_adc = hall_voltage_V(micro.hall, micro.high_mm + beside_mm) / lsb_V;
    params.heater = micro.heater;
    params.wire_limit_degC = micro.fod->high_degC() + above_table_degC;
    params.macro = rig.macro;
    return params;
}

WatchdogState watchdog_start(const WatchdogParams& params) {
    WatchdogState state;
    state.wire_degC = params.heater.ambient_degC;
    return state;
}

Alarm watchdog_update(const WatchdogParams& params, WatchdogState& state, const WatchdogInput& input) {
    const double passed_s = (1 + input.ticks_late) * params.tick_s;
    const bool unattended = !input.attended && input.command.macro_V != 0.0;
    state.unattended_ticks = unattended ? state.unattended_ticks + 1 : 0;
    const int hall = input.sample.hall_adc;
    const bool out = hall < params.hall_low_adc || hall > params.hall_high_adc;
    state.hall_out_s = out ? state.hall_out_s + passed_s : 0.0;
    state.wire_degC = heater_step_degC(params.heater, state.wire_degC, input.command.micro_V, passed_s);
    follow_carriage(params, state, input);
    if (input.ticks_late >= params.late_ticks) return Alarm::late;
    if (state.unattended_ticks >= params.late_ticks) return Alarm::unattended;
    if (state.hall_out_s >= params.hall_limit_s) return Alarm::hall;
    if (state.wire_degC > params.wire_limit_degC) return Alarm::overheated;
    if (std::abs(state.lead_mm) > params.following_limit_mm) return Alarm::not_following;
    return beyond(params, input) ? Alarm::beyond_travel : Alarm::none;
}

std::string text_of(Alarm alarm, const WatchdogParams& params, const WatchdogState& state,
                    const WatchdogInput& input) {
    switch (alarm) {
        case Alarm::none:
            return {};
        case Alarm::late:
            return fmt::format("the control loop was late by {} ticks (allowed: {})", input.ticks_late,
                               params.late_ticks - 1);
        case Alarm::unattended:
            return fmt::format("the motor ran for {} ticks and nobody controlled it", state.unattended_ticks);
        case Alarm::hall:
            return fmt::format(
                "the Hall sensor reads {}, which is not possible: {:.0f} to {:.0f} belong to the travel",
                input.sample.hall_adc, params.hall_low_adc, params.hall_high_adc);
        case Alarm::overheated:
            return fmt::format(
                "the wire is at {:.0f} degC by its commands (allowed: {:.0f}): the micro command was too "
                "high for too long",
                state.wire_degC, params.wire_limit_degC);
        case Alarm::not_following:
            return fmt::format(
                "the carriage does not follow its commands: it should have gone {:.0f} mm {} than the "
                "encoder says (allowed: {:.0f} mm)",
                std::abs(state.lead_mm), state.lead_mm > 0.0 ? "farther up" : "farther down",
                params.following_limit_mm);
        case Alarm::beyond_travel:
            return fmt::format("the encoder is at count {}, beyond the ends of the travel, {:.0f} to {:.0f}",
                               input.sample.encoder_count, input.travel->low_count, input.travel->high_count);
    }
    return {};
}

}  // namespace fidservo::control
