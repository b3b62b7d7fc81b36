#include "plant/thermal_pair.h"

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

/// One regime: the rates of the deviation from the equilibrium.
struct Regime {
    Eigen::Matrix2d rates_per_s;
    Eigen::Vector2d equilibrium_degC;

    Regime(const ThermalPair& pair, double tau_s, double phi_degC) {
        const double a = pair.coupling * tau_s / pair.cooling_tau_s, r = pair.retention;
        rates_per_s << -(1.0 + a) / tau_s, a / tau_s, r / pair.mass_tau_s, -1.0 / pair.mass_tau_s;
        const double wire_degC = phi_degC / (1.0 + a * (1.0 - r));
        equilibrium_degC = {wire_degC, r * wire_degC};
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

    bool wire_rises(const Eigen::Vector2d& rise_degC) const {
        return rates_per_s.row(0).dot(rise_degC - equilibrium_degC) > 0.0;
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

/// When the wire passes phi, if it does within a time; it may come back before the end, as it turns at most
/// once.
std::optional<double> passing_time_s(const Regime& regime, const Eigen::Vector2d& start_degC, double phi_degC,
                                     bool heating, double end_s) {
    const auto rises = [&](double time_s) { return regime.wire_rises(regime.after(start_degC, time_s)); };
    const auto keeps_side = [&](double time_s) {
        return (phi_degC > regime.after(start_degC, time_s).x()) == heating;
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
    bool heating = phi_degC > rise_degC.x();
    Eigen::Vector2d now_degC = rise_degC;
    for (;;) {
        const Regime regime(pair, heating ? pair.heating_tau_s : pair.cooling_tau_s, phi_degC);
        const auto pass_s = passing_time_s(regime, now_degC, phi_degC, heating, time_s);
        if (!pass_s) return regime.after(now_degC, time_s);
        now_degC = regime.after(now_degC, *pass_s);
        time_s -= *pass_s;
        heating = !heating;
    }
}

ThermalPairTick thermal_pair_tick(const ThermalPair& pair, double time_s) {
    return {pair, time_s, Regime(pair, pair.heating_tau_s, 0.0).decay(time_s),
            Regime(pair, pair.cooling_tau_s, 0.0).decay(time_s)};
}

Eigen::Vector2d advance(const ThermalPairTick& tick, const Eigen::Vector2d& rise_degC, double phi_degC) {
    const bool heating = phi_degC > rise_degC.x();
    const Regime regime(tick.pair, heating ? tick.pair.heating_tau_s : tick.pair.cooling_tau_s, phi_degC);
    const Eigen::Vector2d end_degC =
        regime.after(rise_degC, heating ? tick.heating_decay : tick.cooling_decay);
    const bool turns = regime.wire_rises(rise_degC) != regime.wire_rises(end_degC);
    const bool keeps_side = (phi_degC > end_degC.x()) == heating;
    return turns || !keeps_side ? advance(tick.pair, rise_degC, phi_degC, tick.time_s) : end_degC;
}

}  // namespace fidservo::plant
