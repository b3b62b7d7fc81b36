// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/mechanism.h"

#include "core/input_error.h"
#include "plant/macro_axis.h"
#include "plant/motion.h"
#include "plant/motion_shortcuts.h"

#include <algorithm>

namespace fidservo::plant {
namespace {

/// Where the carriage is, and how fast, when what drives it has moved one way to a place.
void carry(const MacroAxis& axis, MacroAxisState& state, double driven_mm, double driven_mm_per_s) {
    const double play_mm = axis.parameters.play_mm;
    if (play_mm == 0.0) {
        state.position_mm = driven_mm;
        state.velocity_mm_per_s = driven_mm_per_s;
        return;
    }
    const double carriage_mm = carried_mm(state.position_mm, driven_mm, play_mm);
    state.velocity_mm_per_s = carriage_mm == state.position_mm ? 0.0 : driven_mm_per_s;
    state.position_mm = carriage_mm;
    state.mechanism.play_mm = carriage_mm - driven_mm;
    state.mechanism.driven_mm_per_s = driven_mm_per_s;
}

/// Throws InputError where motion between two ticks takes more steps than most_steps_a_tick.
void demand_that_it_can_be_followed(int stretches, const StepCount& steps) {
    if (stretches + steps.integrated + steps.in_series > most_steps_a_tick)
        throw InputError(
            "the carriage's forces change its motion too fast to be followed: more than " +
            std::to_string(most_steps_a_tick) +
            " steps of integration between two ticks; allowed: stiffness and friction with which "
            "it takes less");
}

template <std::size_t size>
StepCount move_by_steps(const MacroAxis& axis, MacroAxisState& state, double drive_V, double duration_s) {
    using Motion = plant::Motion<size>;
    MechanismState& mechanism = state.mechanism;
    typename Motion::State start{};
    start[Motion::place] = state.position_mm - mechanism.play_mm;
    start[Motion::speed] =
        axis.parameters.play_mm > 0.0 ? mechanism.driven_mm_per_s : state.velocity_mm_per_s;
    if constexpr (size == 4) {
        start[Motion::stretch] = mechanism.stretch_mm;
        start[Motion::motor] = start[Motion::speed] + mechanism.stretching_mm_per_s;
    }
    Motion motion(axis, drive_V, start, mechanism.bristle_bend, state.formulas);
    constexpr double no_time_s = 1e-15;
    bool moves = true;
    for (int stretches = 0; duration_s > no_time_s && (moves = motion.begin()); ++stretches) {
        demand_that_it_can_be_followed(stretches, motion.steps());
        duration_s -= motion.advance(std::min(duration_s, axis.longest_step_s));
        carry(axis, state, motion.state()[Motion::place], motion.state()[Motion::speed]);
    }
    if (!moves) carry(axis, state, motion.state()[Motion::place], 0.0);
    mechanism.bristle_bend = motion.bend();
    if constexpr (size == 4) {
        mechanism.stretch_mm = motion.state()[Motion::stretch];
        mechanism.stretching_mm_per_s = motion.state()[Motion::motor] - motion.state()[Motion::speed];
    }
    return motion.steps();
}

}  // namespace

WholeSteps whole_steps(const MacroAxis& axis) {
    const Friction& friction = axis.parameters.friction;
    if (!is_straight(axis.parameters.standing) || friction.stribeck_V != 0.0 || axis.has_force_formula ||
        axis.has_friction_formula)
        return {};
    MacroAxis sliding = axis;  // far from a patch
    sliding.parameters.friction.patch.level_V = 0.0;
    sliding.parameters.friction.creep_mm_per_s = 0.0;
    return axis.has_belt ? Motion<4>::whole_steps(sliding) : Motion<2>::whole_steps(sliding);
}

bool has_series(const MacroAxis& axis) {
    return axis.has_standing_force && !is_straight(axis.parameters.standing) && !axis.has_belt &&
           !axis.has_bristles && axis.parameters.friction.stribeck_V == 0.0 && !axis.has_force_formula &&
           !axis.has_friction_formula;
}

StepCount move(const MacroAxis& axis, MacroAxisState& state, double drive_V, double duration_s) {
    return axis.has_belt ? move_by_steps<4>(axis, state, drive_V, duration_s)
                         : move_by_steps<2>(axis, state, drive_V, duration_s);
}

}  // namespace fidservo::plant
