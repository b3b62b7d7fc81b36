#pragma once
// A wire that heats with one time constant and cools with another one, and what it shares its heat with:
// linear within a regime, which may change within a tick.
#include <optional>

namespace fidservo::plant {

/// When a condition that holds at first and not at the end ceases to hold: bisection.
template <class Condition>
double end_of(const Condition& holds, double end_s) {
    constexpr double resolution = 1e-15;
    double before_s = 0.0, after_s = end_s;
    while (after_s - before_s > resolution * end_s) {
        const double middle_s = 0.5 * (before_s + after_s);
        (holds(middle_s) ? before_s : after_s) = middle_s;
    }
    return after_s;
}

/// When the regime ends, if it does within a time; it may come back before the end, as the wire's rise above
/// its surroundings turns at most once.
/// @param model  .above_surroundings(rise_degC), linear: the heater drives the wire upwards while it is less
///               than phi
/// @param regime  .after(rise_degC, time_s), and .per_s(rise_degC)
template <class Model, class Regime, class State>
std::optional<double> passing_time_s(const Model& model, const Regime& regime, const State& start_degC,
                                     double phi_degC, bool heating, double end_s) {
    const auto rises = [&](double time_s) {
        return model.above_surroundings(regime.per_s(regime.after(start_degC, time_s))) > 0.0;
    };
    const auto keeps_side = [&](double time_s) {
        return (model.above_surroundings(regime.after(start_degC, time_s)) < phi_degC) == heating;
    };
    const bool rises_first = rises(0.0);
    const double turn_s = rises(end_s) == rises_first
                              ? end_s
                              : end_of([&](double time_s) { return rises(time_s) == rises_first; }, end_s);
    for (const double until_s : {turn_s, end_s})
        if (!keeps_side(until_s)) return end_of(keeps_side, until_s);
    return std::nullopt;
}

/// What rises above ambient, degC, after a time under a constant phi, however long.
/// @param model  as above, with .regime(heating, phi_degC)
template <class Model, class State>
State through_regimes(const Model& model, State rise_degC, double phi_degC, double time_s) {
    bool heating = model.above_surroundings(rise_degC) < phi_degC;
    for (;;) {
        const auto regime = model.regime(heating, phi_degC);
        const auto pass_s = passing_time_s(model, regime, rise_degC, phi_degC, heating, time_s);
        if (!pass_s) return regime.after(rise_degC, time_s);
        rise_degC = regime.after(rise_degC, *pass_s);
        time_s -= *pass_s;
        heating = !heating;
    }
}

/// The same after a tick.
/// @param decay  of (heating): what is left of a deviation from the regime's equilibrium after a tick
template <class Model, class State, class Decay>
State through_tick(const Model& model, const State& rise_degC, double phi_degC, double tick_s,
                   const Decay& decay) {
    const bool heating = model.above_surroundings(rise_degC) < phi_degC;
    const auto regime = model.regime(heating, phi_degC);
    const State end_degC = regime.equilibrium_degC + decay(heating) * (rise_degC - regime.equilibrium_degC);
    const auto rises = [&](const State& at_degC) {
        return model.above_surroundings(regime.per_s(at_degC)) > 0.0;
    };
    const bool keeps_side = (model.above_surroundings(end_degC) < phi_degC) == heating;
    return rises(rise_degC) != rises(end_degC) || !keeps_side
               ? through_regimes(model, rise_degC, phi_degC, tick_s)
               : end_degC;
}

}  // namespace fidservo::plant
