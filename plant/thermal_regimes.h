// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A wire that heats with one time constant and cools with another one, together with what it exchanges heat
// with. The equations are linear within a regime (heating or cooling), which may change within a tick.
#include <optional>

#include <Eigen/Core>

namespace fidservo::plant {

/// One regime, over ticks of one length: dy/dt = A (y - phi e), y the temperatures above ambient, the wire's
/// first.
template <int size>
struct ThermalRegime {
    using Rise = Eigen::Matrix<double, size, 1>;
    using Matrix = Eigen::Matrix<double, size, size>;

    Matrix rates_per_s;  ///< A
    Rise at_last;        ///< e: equilibrium per unit of phi
    Matrix tick_decay;   ///< exp(A tick)
    /// How fast the wire's rise above its surroundings changes, per unit of deviation from phi e.
    Rise turning_per_s;
};

/// @param surrounding  s: the wire's surroundings rise by s times the second temperature
/// @param decay        exp(A tick)
template <int size>
ThermalRegime<size> thermal_regime(const Eigen::Matrix<double, size, size>& rates_per_s,
                                   const Eigen::Matrix<double, size, 1>& at_last,
                                   const Eigen::Matrix<double, size, size>& decay, double surrounding) {
    return {rates_per_s, at_last, decay, (rates_per_s.row(0) - surrounding * rates_per_s.row(1)).transpose()};
}

/// The time at which a condition that holds at first and not at the end ceases to hold, by bisection.
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

/// The temperatures above ambient, degC, after any time under a constant phi.
/// @param model  .surrounding(), .regime(heating), and .decayed(regime, deviation, time_s): what is left of a
///               deviation from the regime's equilibrium
template <class Model, class Rise>
Rise through_regimes(const Model& model, Rise rise_degC, double phi_degC, double time_s) {
    const auto heats = [&](const Rise& at_degC) {
        return at_degC(0) - model.surrounding() * at_degC(1) < phi_degC;
    };
    bool heating = heats(rise_degC);
    for (;; heating = !heating) {
        const auto& regime = model.regime(heating);
        const Rise equilibrium_degC = phi_degC * regime.at_last, start_degC = rise_degC - equilibrium_degC;
        const auto after = [&](double at_s) { return model.decayed(regime, start_degC, at_s); };
        const auto rises = [&](const Rise& deviation_degC) {
            return regime.turning_per_s.dot(deviation_degC) > 0.0;
        };
        const auto keeps_side = [&](const Rise& deviation_degC) {
            return heats(equilibrium_degC + deviation_degC) == heating;
        };
        const Rise left_degC = after(time_s);
        // The regime may change and come back before the end: the wire's rise above its surroundings reverses
        // at most once.
        const bool rises_first = rises(start_degC), turns = rises(left_degC) != rises_first;
        if (!turns && keeps_side(left_degC)) return equilibrium_degC + left_degC;
        const double turn_s =
            turns ? end_of([&](double at_s) { return rises(after(at_s)) == rises_first; }, time_s) : time_s;
        std::optional<double> pass_s;
        for (const double until_s : {turn_s, time_s})
            if (!pass_s && !keeps_side(after(until_s)))
                pass_s = end_of([&](double at_s) { return keeps_side(after(at_s)); }, until_s);
        rise_degC = equilibrium_degC + after(pass_s.value_or(time_s));
        if (!pass_s) return rise_degC;
        time_s -= *pass_s;
    }
}

/// The temperatures above ambient, degC, after a tick under a constant phi.
template <class Model, class Rise>
Rise through_tick(const Model& model, const Rise& rise_degC, double phi_degC, double tick_s) {
    const double s = model.surrounding();
    const bool heating = rise_degC(0) - s * rise_degC(1) < phi_degC;
    const auto& regime = model.regime(heating);
    const Rise equilibrium_degC = phi_degC * regime.at_last, start_degC = rise_degC - equilibrium_degC,
               left_degC = regime.tick_decay * start_degC, end_degC = equilibrium_degC + left_degC;
    const bool turns =
        (regime.turning_per_s.dot(start_degC) > 0.0) != (regime.turning_per_s.dot(left_degC) > 0.0);
    const bool keeps_side = (end_degC(0) - s * end_degC(1) < phi_degC) == heating;
    return turns || !keeps_side ? through_regimes(model, rise_degC, phi_degC, tick_s) : end_degC;
}

}  // namespace fidservo::plant
