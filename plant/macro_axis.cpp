#include "plant/macro_axis.h"

#include "core/failure.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fidservo::plant {

namespace {

/// Motion from `start` towards a terminal velocity, unhindered by the ends of travel.
MacroAxisState glide(const MacroAxisState& start, double terminal_mm_per_s, double duration_s, double decay,
                     double glide_s) {
    const double excess_mm_per_s = start.velocity_mm_per_s - terminal_mm_per_s;
    return {start.position_mm + terminal_mm_per_s * duration_s + excess_mm_per_s * glide_s,
            terminal_mm_per_s + excess_mm_per_s * decay};
}

MacroAxisState glide(const MacroAxis& axis, const MacroAxisState& start, double terminal_mm_per_s,
                     double duration_s) {
    const double tau_s = axis.parameters.time_constant_s;
    const double lost = -std::expm1(-duration_s / tau_s);
    return glide(start, terminal_mm_per_s, duration_s, 1.0 - lost, tau_s * lost);
}

/// When the carriage turns round, v(t) = 0, if it does so within the tick.
std::optional<double> turning_time_s(const MacroAxis& axis, const MacroAxisState& start,
                                     double terminal_mm_per_s) {
    if (start.velocity_mm_per_s * terminal_mm_per_s >= 0.0) return std::nullopt;
    const double time_s =
        axis.parameters.time_constant_s * std::log1p(-start.velocity_mm_per_s / terminal_mm_per_s);
    return time_s < axis.tick_s ? std::optional(time_s) : std::nullopt;
}

/// When the carriage runs into the end of travel on the given side (+1 right, -1 left), if it does so within
/// the tick. The way outwards is one monotonic piece of the motion: before the turn, or after it.
std::optional<double> impact_time_s(const MacroAxis& axis, const MacroAxisState& start,
                                    double terminal_mm_per_s, double end_mm, double side) {
    const auto turn_s = turning_time_s(axis, start, terminal_mm_per_s);
    const bool leaves_first = side * start.velocity_mm_per_s > 0.0;
    if (!leaves_first && side * terminal_mm_per_s <= 0.0) return std::nullopt;
    if (!leaves_first && start.velocity_mm_per_s != 0.0 && !turn_s) return std::nullopt;
    double before_s = leaves_first ? 0.0 : turn_s.value_or(0.0);
    double after_s = leaves_first ? turn_s.value_or(axis.tick_s) : axis.tick_s;

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

/// A tick during which an end of travel may be met.
MacroAxisState glide_between_ends(const MacroAxis& axis, const MacroAxisState& start,
                                  double terminal_mm_per_s) {
    for (const double side : {-1.0, 1.0}) {
        const double end_mm = side < 0.0 ? axis.parameters.low_mm : axis.parameters.high_mm;
        const auto impact_s = impact_time_s(axis, start, terminal_mm_per_s, end_mm, side);
        if (!impact_s) continue;
        const MacroAxisState stopped{end_mm, 0.0};
        const bool pressed = side * terminal_mm_per_s >= 0.0;
        return pressed ? stopped : glide(axis, stopped, terminal_mm_per_s, axis.tick_s - *impact_s);
    }
    return glide(start, terminal_mm_per_s, axis.tick_s, axis.decay, axis.glide_s);
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
    const double lost = -std::expm1(-tick_s / parameters.time_constant_s);
    return {parameters, tick_s, 1.0 - lost, parameters.time_constant_s * lost};
}

double drive_voltage_V(const MacroAxisParameters& parameters, double command_V) {
    const double limit_V = parameters.command_limit_V;
    return parameters.drive_gain * std::clamp(command_V, -limit_V, limit_V);
}

double effective_voltage_V(const MacroAxisParameters& parameters, double command_V) {
    const double drive_V = drive_voltage_V(parameters, command_V) + parameters.drive_bias_V;
    const DeadZone& zone = parameters.dead_zone;
    const double size_V = std::abs(drive_V);
    if (size_V < zone.threshold_V || size_V == 0.0) return 0.0;
    return std::copysign(zone.offset_V + zone.slope * (size_V - zone.threshold_V), drive_V);
}

void advance(const MacroAxis& axis, MacroAxisState& state, double command_V) {
    const MacroAxisParameters& parameters = axis.parameters;
    const double terminal_mm_per_s =
        parameters.velocity_gain_mm_per_s_per_V * effective_voltage_V(parameters, command_V);
    const double reach_mm =
        std::max(std::abs(state.velocity_mm_per_s), std::abs(terminal_mm_per_s)) * axis.tick_s;
    const bool far_from_ends = state.position_mm - reach_mm >= parameters.low_mm &&
                               state.position_mm + reach_mm <= parameters.high_mm;
    state = far_from_ends ? glide(state, terminal_mm_per_s, axis.tick_s, axis.decay, axis.glide_s)
                          : glide_between_ends(axis, state, terminal_mm_per_s);
}

}  // namespace fidservo::plant
