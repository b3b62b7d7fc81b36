// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/stage_check.h"

#include "control/watchdog.h"
#include "core/dead_zone.h"
#include "core/rig.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::control {

namespace {

/// Pushes in the order in which they are tried: the sign is the direction, the amount the share of the way
/// from the dead zone's edge to the command's limit.
constexpr std::array pushes{0.1, -0.1, 0.4, -0.4};
constexpr double heat_rise_degC = 78.0;  ///< carries the wire over its transformation, and harms it never
constexpr double answer_mm = 0.05;       ///< of the platform
constexpr int rest_counts = 2;           ///< that the encoder may show of a stage at rest
constexpr double cooling_taus = 3.0;

void enter_check(StageCheckState& state, StageCheckPhase phase) {
    if (state.phase == StageCheckPhase::push) state.pushed_s = state.phase_s;
    state.phase = phase;
    state.phase_start_ns.reset();
}

void fail_check(StageCheckState& state, std::string why) {
    state.why = std::move(why);
    enter_check(state, StageCheckPhase::failed);
}

struct Push {
    double command_V;
    double duration_s;
};

/// A push that would carry the stage move_mm, coasting included: a first-order lag has the area of its input.
Push push_of(const StageCheckParams& params, int attempt) {
    const double strength = pushes[static_cast<std::size_t>(attempt)];
    const DeadZone& zone = params.macro.dead_zone;
    const double above_V = std::abs(strength) * (params.macro.command_limit_V - zone.threshold_V);
    const double amount_V = zone.threshold_V + above_V;
    const double speed = dead_zone_V(zone, amount_V) * params.macro.velocity_gain_mm_per_s_per_V;
    return {std::copysign(amount_V, strength), params.move_mm / speed};
}

double moved_mm(const StageCheckParams& params, const StageCheckState& state, const StageSample& sample) {
    return static_cast<double>(sample.encoder_count - state.start_count) * params.macro.encoder_resolution_mm;
}

void rest(const StageCheckParams& params, StageCheckState& state, const StageSample& sample) {
    if (state.hall_samples++ == 0) state.start_count = sample.encoder_count;
    state.hall_sum += sample.hall_adc;
    if (std::abs(sample.encoder_count - state.start_count) > rest_counts)
        return fail_check(state, "the encoder moves although the motor is off");
    if (state.phase_s < params.rest_s) return;
    const double hall = state.hall_sum / state.hall_samples;
    if (hall < params.hall_low_adc || hall > params.hall_high_adc)
        return fail_check(
            state, fmt::format("the Hall sensor reads {:.0f}; {:.0f} to {:.0f} belong to the travel", hall,
                               params.hall_low_adc, params.hall_high_adc));
    enter_check(state, StageCheckPhase::push);
}

void judge_push(const StageCheckParams& params, StageCheckState& state, const StageSample& sample) {
    const Push push = push_of(params, state.attempt);
    const double along_mm = std::copysign(1.0, push.command_V) * moved_mm(params, state, sample);
    // A push that a late loop drew out is good for more.
    const double good_for_mm = params.move_mm * state.pushed_s / push.duration_s;
    if (std::abs(along_mm) < params.least_share * params.move_mm) {
        if (++state.attempt == static_cast<int>(pushes.size()))
            return fail_check(state, "the encoder does not answer to the motor, whichever way it is pushed");
        state.start_count = sample.encoder_count;
        return enter_check(state, StageCheckPhase::push);
    }
    if (along_mm < 0.0)
        return fail_check(
            state, fmt::format("the encoder ran {:.2f} mm against the motor: one of "
                               "stage.comedi.macro.reversed and stage.comedi.encoder.reversed is wrong",
                               -along_mm));
    if (along_mm > params.most_share * good_for_mm)
        return fail_check(state, fmt::format("the encoder ran {:.2f} mm at a push that is good for {:.2f} mm",
                                             along_mm, good_for_mm));
    state.moved_mm = along_mm;
    enter_check(state, StageCheckPhase::back);
}

/// The platform may still be on its way down from an earlier heating: what counts is its way up from the
/// lowest place.
void judge_heat(const StageCheckParams& params, StageCheckState& state, const StageSample& sample) {
    const int lowest = state.lowest_hall_adc.value_or(sample.hall_adc);
    state.lowest_hall_adc = std::min(lowest, sample.hall_adc);
    if (sample.hall_adc - *state.lowest_hall_adc >= params.hall_answer_adc)
        return enter_check(state, StageCheckPhase::cool);
    if (state.phase_s < params.heat_limit_s) return;
    const double change = sample.hall_adc - state.hall_sum / state.hall_samples;
    if (change <= -params.hall_answer_adc)
        return fail_check(state, "the Hall sensor's reading falls when the wire is heated");
    fail_check(state, fmt::format("the Hall sensor does not answer to the heater: {:.0f} after {:.1f} s",
                                  change, params.heat_limit_s));
}

void advance_check(const StageCheckParams& params, StageCheckState& state, const StageSample& sample) {
    switch (state.phase) {
        case StageCheckPhase::rest:
            return rest(params, state, sample);
        case StageCheckPhase::push:
            if (state.phase_s >= push_of(params, state.attempt).duration_s)
                enter_check(state, StageCheckPhase::coast);
            return;
        case StageCheckPhase::coast:
            if (state.phase_s >= params.coast_s) judge_push(params, state, sample);
            return;
        case StageCheckPhase::back:
            if (state.phase_s >= push_of(params, state.attempt).duration_s)
                enter_check(state, StageCheckPhase::settle);
            return;
        case StageCheckPhase::settle:
            if (state.phase_s >= params.coast_s) enter_check(state, StageCheckPhase::heat);
            return;
        case StageCheckPhase::heat:
            return judge_heat(params, state, sample);
        case StageCheckPhase::cool:
            if (state.phase_s >= params.cool_s) enter_check(state, StageCheckPhase::passed);
            return;
        case StageCheckPhase::passed:
        case StageCheckPhase::failed:
            return;
    }
}

}  // namespace

StageCheckParams stage_check_params(const Rig& rig) {
    const WatchdogParams watched = watchdog_params(rig);
    const MicroParameters& micro = rig.micro.value();
    StageCheckParams params{};
    params.macro = rig.macro;
    params.hall_low_adc = watched.hall_low_adc;
    params.hall_high_adc = watched.hall_high_adc;
    params.hall_answer_adc =
        answer_mm * hall_slope_V_per_mm(micro.hall, micro.low_mm) / hall_lsb_V(micro.hall);
    params.heat_V = micro.heater.onset_V + heat_rise_degC / micro.heater.gain_degC_per_V;
    params.cool_s = cooling_taus * micro.heater.cooling_tau_s;
    return params;
}

StageCommand stage_check_update(const StageCheckParams& params, StageCheckState& state,
                                const StageSample& sample) {
    if (!state.phase_start_ns) state.phase_start_ns = sample.time_ns;
    state.phase_s = seconds(sample.time_ns - *state.phase_start_ns);
    advance_check(params, state, sample);
    if (!state.phase_start_ns) state.phase_start_ns = sample.time_ns;
    if (state.phase == StageCheckPhase::push) return {push_of(params, state.attempt).command_V, 0.0};
    if (state.phase == StageCheckPhase::back) return {-push_of(params, state.attempt).command_V, 0.0};
    if (state.phase == StageCheckPhase::heat) return {0.0, params.heat_V};
    return {};
}

bool stage_check_is_done(const StageCheckState& state) {
    return state.phase == StageCheckPhase::passed || state.phase == StageCheckPhase::failed;
}

}  // namespace fidservo::control
