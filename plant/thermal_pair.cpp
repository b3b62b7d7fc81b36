#include "plant/thermal_pair.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fidservo::plant {

namespace {

/// exp(m t) sinh(d t) / d, t exp(m t) where both rates are the same.
double difference_of_decays(double m, double d, double t) {
    constexpr double small = 1e-4;
    const double x = d * t;
    if (x < small) return t * std::exp(m * t) * (1.0 + x * x / 6.0);
    return (std::exp((m + d) * t) - std::exp((m - d) * t)) / (2.0 * d);
}

/// s: of what the mass gives back, what warms the surroundings.
double surrounding(const ThermalPair& pair) {
    return pair.coupling * std::max(0.0, 1.0 - pair.taken);
}

/// Whether the heater, phi, drives the wire upwards.
bool heats(const ThermalPair& pair, const Eigen::Vector2d& rise_degC, double phi_degC) {
    return phi_degC > rise_degC.x() - surrounding(pair) * rise_degC.y();
}

/// One regime: the rates of the deviation from the equilibrium.
struct Regime {
    Eigen::Matrix2d rates_per_s;
    Eigen::Vector2d equilibrium_degC;

    Regime(const ThermalPair& pair, bool heating, double phi_degC) {
        const double tau_s = heating ? pair.heating_tau_s : pair.cooling_tau_s;
        const double s = surrounding(pair), p = std::max(1.0, pair.taken);
        const double e = (pair.coupling - s) * (heating ? pair.heating : 1.0) * tau_s / pair.cooling_tau_s;
        rates_per_s << -(1.0 + e * p) / tau_s, (s + e) / tau_s, 1.0 / pair.mass_tau_s, -1.0 / pair.mass_tau_s;
        const double at_last_degC = phi_degC / (1.0 - s + e * (p - 1.0));
        equilibrium_degC = {at_last_degC, at_last_degC};
    }

    Eigen::Matrix2d decay(double time_s) const {
        const Eigen::Matrix2d& A = rates_per_s;
        const double m = 0.5 * (A(0, 0) + A(1, 1));
        const double d = std::hypot(0.5 * (A(0, 0) - A(1, 1)), std::sqrt(A(0, 1) * A(1, 0)));
        const double mean_of_decays = 0.5 * (std::exp((m + d) * time_s) + std::exp((m - d) * time_s));
        const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
        return mean_of_decays * identity + difference_of_decays(m, d, time_s) * (A - m * identity);
    }

    Eigen::Vector2d after(const Eigen::Vector2d& rise_degC, const Eigen::Matrix2d& decay) const {
        return equilibrium_degC + decay * (rise_degC - equilibrium_degC);
    }

    Eigen::Vector2d after(const Eigen::Vector2d& rise_degC, double time_s) const {
        return after(rise_degC, decay(time_s));
    }

    /// Whether q - s b rises, on which the regime depends.
    bool comes_closer(const ThermalPair& pair, const Eigen::Vector2d& rise_degC) const {
        const Eigen::Vector2d per_s = rates_per_s * (rise_degC - equilibrium_degC);
        return per_s.x() - surrounding(pair) * per_s.y() > 0.0;
    }
};

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

/// When the regime ends, if it does within a time; it may come back before the end, as q - s b turns at most
/// once.
std::optional<double> passing_time_s(const ThermalPair& pair, const Regime& regime,
                                     const Eigen::Vector2d& start_degC, double phi_degC, bool heating,
                                     double end_s) {
    const auto rises = [&](double time_s) {
        return regime.comes_closer(pair, regime.after(start_degC, time_s));
    };
    const auto keeps_side = [&](double time_s) {
        return heats(pair, regime.after(start_degC, time_s), phi_degC) == heating;
    };
    const bool rises_first = rises(0.0);
    const double turn_s = rises(end_s) == rises_first
                              ? end_s
                              : end_of([&](double time_s) { return rises(time_s) == rises_first; }, end_s);
    for (const double until_s : {turn_s, end_s})
        if (!keeps_side(until_s)) return end_of(keeps_side, until_s);
    return std::nullopt;
}

}  // namespace

Eigen::Vector2d advance(const ThermalPair& pair, const Eigen::Vector2d& rise_degC, double phi_degC,
                        double time_s) {
    bool heating = heats(pair, rise_degC, phi_degC);
    Eigen::Vector2d now_degC = rise_degC;
    for (;;) {
        const Regime regime(pair, heating, phi_degC);
        const auto pass_s = passing_time_s(pair, regime, now_degC, phi_degC, heating, time_s);
        if (!pass_s) return regime.after(now_degC, time_s);
        now_degC = regime.after(now_degC, *pass_s);
        time_s -= *pass_s;
        heating = !heating;
    }
}

ThermalPairTick thermal_pair_tick(const ThermalPair& pair, double time_s) {
    return {pair, time_s, Regime(pair, true, 0.0).decay(time_s), Regime(pair, false, 0.0).decay(time_s)};
}

Eigen::Vector2d advance(const ThermalPairTick& tick, const Eigen::Vector2d& rise_degC, double phi_degC) {
    const bool heating = heats(tick.pair, rise_degC, phi_degC);
    const Regime regime(tick.pair, heating, phi_degC);
    const Eigen::Vector2d end_degC =
        regime.after(rise_degC, heating ? tick.heating_decay : tick.cooling_decay);
    const bool turns = regime.comes_closer(tick.pair, rise_degC) != regime.comes_closer(tick.pair, end_degC);
    const bool keeps_side = heats(tick.pair, end_degC, phi_degC) == heating;
    return turns || !keeps_side ? advance(tick.pair, rise_degC, phi_degC, tick.time_s) : end_degC;
}

}  // namespace fidservo::plant
