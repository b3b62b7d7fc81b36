// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/positioner.h"

#include "core/demand.h"

#include <algorithm>
#include <cmath>

namespace fidservo::control {

namespace {

void enter_phase(PositionerState& state, PositionerPhase phase) {
    state.phase = phase;
    state.phase_s = 0.0;
}

void give_up(PositionerState& state, Reason why) {
    state.why = why;
    state.macro.setpoint_count.reset();
    enter_phase(state, PositionerPhase::failed);
}

bool in_reach(const PositionerParams& params, double position_mm) {
    return position_mm >= params.reach_low_mm && position_mm <= params.reach_high_mm;
}

/// Begins a move of the macro stage by the distance needed, less the distance by which the platform has to
/// move to return to its parking range, from which it can move both ways.
void begin_macro(const PositionerParams& params, PositionerState& state, double needed_mm) {
    const double platform_mm = state.micro.average_mm;
    const bool parked_well = platform_mm >= params.park_low_mm && platform_mm <= params.park_high_mm;
    const double goal_mm = parked_well ? platform_mm : 0.5 * (params.park_low_mm + params.park_high_mm);
    const double carriage_mm = needed_mm - (goal_mm - platform_mm);
    const double goal_count =
        static_cast<double>(state.macro.last_count.value_or(0)) + carriage_mm / params.count_mm;
    macro_go_to(state.macro, std::clamp(goal_count, state.travel.low_count, state.travel.high_count));
    enter_phase(state, PositionerPhase::macro_move);
}

void begin_look(PositionerState& state, TimeNs now_ns) {
    state.rest_since_ns = now_ns;
    state.frames = 0;
    enter_phase(state, PositionerPhase::look);
}

void begin_micro(const PositionerParams& params, PositionerState& state) {
    if (++state.moves > params.most_moves) return give_up(state, Reason::no_convergence);
    micro_begin_move(params.micro, state.micro, state.micro.average_mm + state.reached.needed_mm);
    enter_phase(state, PositionerPhase::micro_move);
}

/// Decides on two frames that agree.
void decide(const PositionerParams& params, PositionerState& state) {
    if (std::abs(state.reached.needed_mm) <= params.tolerance_mm)
        return enter_phase(state, PositionerPhase::arrived);
    if (in_reach(params, state.micro.average_mm + state.reached.needed_mm)) return begin_micro(params, state);
    if (++state.recentres > params.most_recentres) return give_up(state, Reason::out_of_reach);
    begin_macro(params, state, state.reached.needed_mm);
}

void look(const PositionerParams& params, PositionerState& state, const std::optional<TargetOffset>& seen) {
    if (state.phase_s > params.look_timeout_s)
        return give_up(state, state.frames ? Reason::not_at_rest : Reason::no_tag);
    if (!seen || seen->time_ns < state.rest_since_ns) return;
    state.looks[0] = state.looks[1];
    state.looks[1] = *seen;
    if (++state.frames < 2) return;
    const auto& [before, now] = state.looks;
    const double std_mm = std::hypot(before.std_mm, now.std_mm, params.rest_std_mm);
    if (std::abs(now.needed_mm - before.needed_mm) > 4.0 * std_mm) return;
    state.reached = combine_looks(before, now);
    decide(params, state);
}

void macro_move(const PositionerParams& params, PositionerState& state) {
    if (macro_is_near(state.macro, params.macro_near_count) || macro_is_quiet(params.macro, state.macro)) {
        state.macro.setpoint_count.reset();
        enter_phase(state, PositionerPhase::macro_settle);
    } else if (state.phase_s > params.macro_timeout_s) {
        give_up(state, Reason::no_convergence);
    }
}

void advance_phase(const PositionerParams& params, PositionerState& state, const StageSample& sample,
                   const std::optional<TargetOffset>& seen) {
    switch (state.phase) {
        case PositionerPhase::macro_move:
            return macro_move(params, state);
        case PositionerPhase::macro_settle:
            if (!macro_is_quiet(params.macro, state.macro)) return;
            state.macro_s = state.move_s;
            return begin_look(state, sample.time_ns);
        case PositionerPhase::look:
            return look(params, state, seen);
        case PositionerPhase::micro_move:
            if (state.micro.phase == MicroPhase::failed) return give_up(state, Reason::no_convergence);
            if (state.micro.phase == MicroPhase::hold) enter_phase(state, PositionerPhase::micro_settle);
            return;
        case PositionerPhase::micro_settle:
            if (state.phase_s >= params.micro_settle_s) begin_look(state, sample.time_ns);
            return;
        case PositionerPhase::idle:
        case PositionerPhase::arrived:
        case PositionerPhase::failed:
            return;
    }
}

}  // namespace

TargetOffset combine_looks(const TargetOffset& before, const TargetOffset& now) {
    FIDSERVO_DEMAND(before.std_mm > 0.0 && now.std_mm > 0.0);
    const double difference_mm = now.needed_mm - before.needed_mm;
    const double own_mm2 = before.std_mm * before.std_mm + now.std_mm * now.std_mm;
    const double between_mm2 = 0.5 * std::max(0.0, difference_mm * difference_mm - own_mm2);
    const double weight_before = 1.0 / (before.std_mm * before.std_mm + between_mm2);
    const double weight_now = 1.0 / (now.std_mm * now.std_mm + between_mm2);
    const double weights = weight_before + weight_now;
    return {now.time_ns, (weight_before * before.needed_mm + weight_now * now.needed_mm) / weights,
            1.0 / std::sqrt(weights)};
}

PositionerState positioner_start(const PositionerParams& params) {
    PositionerState state;
    state.micro = micro_start(params.micro);
    return state;
}

void positioner_begin(const PositionerParams& params, PositionerState& state, double needed_mm,
                      const CarriageTravel& travel) {
    state.travel = travel;
    state.move_s = state.macro_s = state.micro_s = 0.0;
    state.moves = state.recentres = 0;
    if (in_reach(params, state.micro.average_mm + needed_mm)) {
        enter_phase(state, PositionerPhase::macro_settle);
    } else {
        begin_macro(params, state, needed_mm);
    }
}

PositionerOutput positioner_update(const PositionerParams& params, PositionerState& state,
                                   const StageSample& sample, const std::optional<TargetOffset>& seen) {
    const double macro_V = macro_update(params.macro, state.macro, sample.encoder_count);
    const double micro_V = micro_update(params.micro, state.micro, sample.hall_adc);
    state.phase_s += params.macro.tick_s;
    state.move_s += params.macro.tick_s;
    if (state.moves > 0) state.micro_s += params.macro.tick_s;
    advance_phase(params, state, sample, seen);
    return {{macro_V, micro_V}, state.phase == PositionerPhase::look};
}

bool positioner_is_done(const PositionerState& state) {
    return state.phase == PositionerPhase::arrived || state.phase == PositionerPhase::failed ||
           state.phase == PositionerPhase::idle;
}

}  // namespace fidservo::control
