// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/macro_axis.h"

#include "core/dead_zone.h"
#include "core/demand.h"
#include "core/input_error.h"
#include "core/rig.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace fidservo::plant {

namespace {

struct Glide {
    double position_mm;
    double velocity_mm_per_s;
};

/// Motion from `start` towards a terminal velocity, unhindered by the ends of travel.
Glide glide(const Glide& start, double terminal_mm_per_s, double duration_s, double decay, double glide_s) {
    const double excess_mm_per_s = start.velocity_mm_per_s - terminal_mm_per_s;
    return {start.position_mm + terminal_mm_per_s * duration_s + excess_mm_per_s * glide_s,
            terminal_mm_per_s + excess_mm_per_s * decay};
}

Glide glide(const MacroAxis& axis, const Glide& start, double terminal_mm_per_s, double duration_s) {
    const double tau_s = axis.parameters.time_constant_s;
    const double lost = -std::expm1(-duration_s / tau_s);
    return glide(start, terminal_mm_per_s, duration_s, 1.0 - lost, tau_s * lost);
}

/// When the carriage turns round, v(t) = 0, if it does so within the duration.
std::optional<double> turning_time_s(const MacroAxis& axis, const Glide& start, double terminal_mm_per_s,
                                     double duration_s) {
    if (start.velocity_mm_per_s * terminal_mm_per_s >= 0.0) return std::nullopt;
    const double time_s =
        axis.parameters.time_constant_s * std::log1p(-start.velocity_mm_per_s / terminal_mm_per_s);
    return time_s < duration_s ? std::optional(time_s) : std::nullopt;
}

/// When the carriage runs into the end of travel on the given side (+1 right, -1 left), if it does so within
/// the duration. The way outwards is one monotonic piece of the motion: before the turn, or after it.
std::optional<double> impact_time_s(const MacroAxis& axis, const Glide& start, double terminal_mm_per_s,
                                    double duration_s, double end_mm, double side) {
    const auto turn_s = turning_time_s(axis, start, terminal_mm_per_s, duration_s);
    const bool leaves_first = side * start.velocity_mm_per_s > 0.0;
    if (!leaves_first && side * terminal_mm_per_s <= 0.0) return std::nullopt;
    if (!leaves_first && start.velocity_mm_per_s != 0.0 && !turn_s) return std::nullopt;
    double before_s = leaves_first ? 0.0 : turn_s.value_or(0.0);
    double after_s = leaves_first ? turn_s.value_or(duration_s) : duration_s;

    const auto beyond = [&](double time_s) {
        return side * (glide(axis, start, terminal_mm_per_s, time_s).position_mm - end_mm) > 0.0;
    };
    if (!beyond(after_s)) return std::nullopt;
    constexpr double resolution_s = 1e-15;
    while (after_s - before_s > resolution_s) {
        const double middle_s = 0.5 * (before_s + after_s);
        (beyond(middle_s) ? after_s : before_s) = middle_s;
    }
    return before_s;
}

/// Motion during which an end of travel may be met.
Glide glide_between_ends(const MacroAxis& axis, const Glide& start, double terminal_mm_per_s,
                         double duration_s) {
    for (const double side : {-1.0, 1.0}) {
        const double end_mm = side < 0.0 ? axis.parameters.low_mm : axis.parameters.high_mm;
        const auto impact_s = impact_time_s(axis, start, terminal_mm_per_s, duration_s, end_mm, side);
        if (!impact_s) continue;
        const Glide stopped{end_mm, 0.0};
        const bool pressed = side * terminal_mm_per_s >= 0.0;
        return pressed ? stopped : glide(axis, stopped, terminal_mm_per_s, duration_s - *impact_s);
    }
    return glide(axis, start, terminal_mm_per_s, duration_s);
}

/// The exact solution over a tick or a part of one.
void advance_in_closed_form(const MacroAxis& axis, MacroAxisState& state, double drive_V, double duration_s) {
    const MacroAxisParameters& parameters = axis.parameters;
    const double terminal_mm_per_s =
        parameters.velocity_gain_mm_per_s_per_V *
        dead_zone_V(parameters.dead_zone, drive_V, parameters.dead_zone_on_motion);
    const double reach_mm =
        std::max(std::abs(state.velocity_mm_per_s), std::abs(terminal_mm_per_s)) * duration_s;
    const bool far_from_ends = state.position_mm - reach_mm >= parameters.low_mm &&
                               state.position_mm + reach_mm <= parameters.high_mm;
    const Glide before{state.position_mm, state.velocity_mm_per_s};
    const Glide after = !far_from_ends ? glide_between_ends(axis, before, terminal_mm_per_s, duration_s)
                        : duration_s == axis.tick_s
                            ? glide(before, terminal_mm_per_s, duration_s, axis.decay, axis.glide_s)
                            : glide(axis, before, terminal_mm_per_s, duration_s);
    state.position_mm = after.position_mm;
    state.velocity_mm_per_s = after.velocity_mm_per_s;
}

/// The variables of formulas at the beginning of a tick.
/// @param drive_V  without formulas
std::array<double, carriage_variable::count> variables_at_tick(const MacroAxis& axis,
                                                               const MacroAxisState& state, double drive_V) {
    const MacroAxisParameters& parameters = axis.parameters;
    CarriageSight sight{state.position_mm, state.velocity_mm_per_s,
                        state.velocity_mm_per_s < 0.0 ? -1.0 : 1.0};
    double w_V = drive_V + StandingForceNearby(parameters.standing).volts(state.position_mm);
    for (const Port port : {Port::drive_voltage, Port::force})
        if (parameters.formulas.act(port)) w_V += formula_V(parameters.formulas, state.formulas, port, sight);
    sight.voltage_V = dead_zone_V(parameters.dead_zone, w_V, parameters.dead_zone_on_motion);
    return formula_variables(state.formulas, sight);
}

StepCount advance_by(const MacroAxis& axis, MacroAxisState& state, double command_V, double duration_s) {
    const MacroAxisParameters& parameters = axis.parameters;
    double drive_V = drive_voltage_V(parameters, command_V) + parameters.drive_bias_V;
    if (parameters.formulas.any()) {
        state.formulas.command_V = saturated_V(parameters, command_V);
        if (parameters.formulas.act(Port::drive_voltage))
            drive_V += parameters.formulas.value(Port::drive_voltage, variables_at_tick(axis, state, drive_V),
                                                 state.formulas.memory);
    }
    if (!axis.has_closed_form) return move(axis, state, drive_V, duration_s);
    advance_in_closed_form(axis, state, drive_V, duration_s);
    return {};
}

StepCount advance_by_tick(const MacroAxis& axis, MacroAxisState& state, double command_V) {
    if (axis.parameters.delay_s == 0.0) return advance_by(axis, state, command_V, axis.tick_s);
    StepCount steps;
    pass(state.delay, axis.parameters.delay_s, axis.tick_s, command_V,
         [&](double acting_V, double duration_s) { steps += advance_by(axis, state, acting_V, duration_s); });
    return steps;
}

}  // namespace

MacroAxisParameters macro_axis_parameters(const Rig& rig) {
    const MacroParameters& macro = rig.macro;
    return {.low_mm = macro.low_mm,
            .high_mm = macro.high_mm,
            .command_limit_V = macro.command_limit_V,
            .dead_zone = macro.dead_zone,
            .velocity_gain_mm_per_s_per_V = macro.velocity_gain_mm_per_s_per_V,
            .time_constant_s = -rig.tick_s / std::log(macro.velocity_pole)};
}

MacroAxis make_macro_axis(const MacroAxisParameters& parameters, double tick_s) {
    FIDSERVO_DEMAND(tick_s > 0.0 && parameters.time_constant_s > 0.0 &&
                    parameters.low_mm < parameters.high_mm);
    const Friction& friction = parameters.friction;
    const double gain = parameters.velocity_gain_mm_per_s_per_V;
    if (1.0 + gain * std::min(friction.right_V_s_per_mm, friction.left_V_s_per_mm) <= 0.0)
        throw InputError("friction_asymmetry: takes away more than the rig's damping of " +
                         std::to_string(1.0 / gain) + " V s/mm");
    const double lost = -std::expm1(-tick_s / parameters.time_constant_s);
    MacroAxis axis{parameters, tick_s, 1.0 - lost, parameters.time_constant_s * lost};
    axis.has_force_formula = parameters.formulas.act(Port::force);
    axis.has_friction_formula = parameters.formulas.act(Port::friction);
    axis.has_standing_force = acts(parameters.standing) || axis.has_force_formula;
    axis.has_friction = acts(friction) || axis.has_friction_formula;
    axis.has_bristles = has_bristles(friction);
    const bool speed_counts = parameters.formulas.use(carriage_variable::speed) ||
                              parameters.formulas.use(carriage_variable::direction);
    axis.force_turns = axis.has_force_formula && speed_counts;
    axis.is_pushed_back = axis.force_turns || (axis.has_friction_formula && speed_counts);
    axis.turns_matter = axis.has_friction || parameters.play_mm > 0.0 || axis.force_turns;
    axis.has_belt = parameters.belt.compliance_mm_per_V >= least_compliance_mm_per_V;
    if (axis.has_belt) axis.belt = belt_force(parameters.belt, gain, parameters.time_constant_s);
    axis.driven_low_mm = parameters.low_mm - 0.5 * parameters.play_mm;
    axis.driven_high_mm = parameters.high_mm + 0.5 * parameters.play_mm;
    axis.longest_step_s = tick_s;
    if (axis.has_belt)
        axis.longest_step_s =
            tick_s / std::ceil(tick_s * natural_frequency_rad_per_s(parameters.belt, gain,
                                                                    parameters.time_constant_s));
    axis.has_closed_form =
        !axis.has_standing_force && !axis.has_friction && !axis.has_belt && parameters.play_mm == 0.0;
    if (!axis.has_closed_form) axis.whole_steps = whole_steps(axis);
    axis.has_series = has_series(axis);
    return axis;
}

MacroAxisState start(const MacroAxis& axis, double position_mm) {
    MacroAxisState state{.position_mm = position_mm};
    if (axis.parameters.delay_s > 0.0) state.delay = start_delay_line(axis.parameters.delay_s, axis.tick_s);
    const Formulas& formulas = axis.parameters.formulas;
    if (formulas.remember())
        state.formulas.memory =
            formulas.start(variables_at_tick(axis, state, axis.parameters.drive_bias_V), axis.tick_s);
    return state;
}

std::array<double, carriage_variable::count> formula_variables(const CarriageFormulaState& seen,
                                                               const CarriageSight& sight) {
    using namespace carriage_variable;
    std::array<double, count> variables{};
    variables[time] = seen.time_s;
    variables[command] = seen.command_V;
    variables[voltage] = sight.voltage_V;
    variables[place] = sight.place_mm;
    variables[speed] = sight.speed_mm_per_s;
    variables[direction] = sight.direction;
    variables[way] = seen.way_mm;
    return variables;
}

double drive_voltage_V(const MacroAxisParameters& parameters, double command_V) {
    return parameters.drive_gain * saturated_V(parameters, command_V);
}

double effective_voltage_V(const MacroAxisParameters& parameters, double command_V) {
    const double drive_V = drive_voltage_V(parameters, command_V) + parameters.drive_bias_V;
    return dead_zone_V(parameters.dead_zone, drive_V, parameters.dead_zone_on_motion);
}

StepCount advance(const MacroAxis& axis, MacroAxisState& state, double command_V) {
    const Formulas& formulas = axis.parameters.formulas;
    if (!formulas.any()) return advance_by_tick(axis, state, command_V);
    if (formulas.remember()) {
        state.formulas.command_V = saturated_V(axis.parameters, command_V);
        const double drive_V = drive_voltage_V(axis.parameters, command_V) + axis.parameters.drive_bias_V;
        formulas.begin_tick(state.formulas.memory, variables_at_tick(axis, state, drive_V), axis.tick_s);
    }
    const double before_mm = state.position_mm;
    const StepCount steps = advance_by_tick(axis, state, command_V);
    state.formulas.time_s += axis.tick_s;
    state.formulas.way_mm += std::abs(state.position_mm - before_mm);
    return steps;
}

}  // namespace fidservo::plant
