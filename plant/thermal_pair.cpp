// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/thermal_pair.h"

#include <algorithm>
#include <cmath>

namespace fidservo::plant {

namespace {

/// exp(m t) sinh(d t) / d, t exp(m t) where both rates are the same.
double difference_of_decays(double m, double d, double t) {
    constexpr double small = 1e-4;
    const double x = d * t;
    if (x < small) return t * std::exp(m * t) * (1.0 + x * x / 6.0);
    return (std::exp((m + d) * t) - std::exp((m - d) * t)) / (2.0 * d);
}

Eigen::Matrix2d decay(const Eigen::Matrix2d& A, double time_s) {
    const double m = 0.5 * (A(0, 0) + A(1, 1));
    const double d = std::hypot(0.5 * (A(0, 0) - A(1, 1)), std::sqrt(A(0, 1) * A(1, 0)));
    const double mean_of_decays = 0.5 * (std::exp((m + d) * time_s) + std::exp((m - d) * time_s));
    const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
    return mean_of_decays * identity + difference_of_decays(m, d, time_s) * (A - m * identity);
}

ThermalRegime<2> pair_regime_of(const ThermalPair& pair, bool heating, double tick_s) {
    const double tau_s = heating ? pair.heating_tau_s : pair.cooling_tau_s;
    const double s = pair.surrounding(), p = pair.drawn();
    const double e = (pair.coupling - s) * (heating ? pair.heating : 1.0) * tau_s / pair.cooling_tau_s;
    Eigen::Matrix2d rates_per_s;
    rates_per_s << -(1.0 + e * p) / tau_s, (s + e) / tau_s, 1.0 / pair.mass_tau_s, -1.0 / pair.mass_tau_s;
    const Eigen::Vector2d at_last = Eigen::Vector2d::Constant(1.0 / (1.0 - s + e * (p - 1.0)));
    return thermal_regime<2>(rates_per_s, at_last, decay(rates_per_s, tick_s), s);
}

struct PairModel {
    const ThermalPairTick& tick;

    double surrounding() const { return tick.surrounding; }
    const ThermalRegime<2>& regime(bool heating) const { return heating ? tick.heating : tick.cooling; }
    static Eigen::Vector2d decayed(const ThermalRegime<2>& regime, const Eigen::Vector2d& deviation,
                                   double time_s) {
        return decay(regime.rates_per_s, time_s) * deviation;
    }
};

}  // namespace

double ThermalPair::surrounding() const {
    return is_source ? 0.0 : coupling * std::max(0.0, 1.0 - taken);
}

double ThermalPair::drawn() const {
    return is_source ? taken : std::max(1.0, taken);
}

ThermalPairTick thermal_pair_tick(const ThermalPair& pair, double time_s) {
    return {time_s, pair.surrounding(), pair_regime_of(pair, true, time_s),
            pair_regime_of(pair, false, time_s)};
}

Eigen::Vector2d advance(const ThermalPairTick& tick, const Eigen::Vector2d& rise_degC, double phi_degC,
                        double time_s) {
    return through_regimes(PairModel{tick}, rise_degC, phi_degC, time_s);
}

Eigen::Vector2d advance(const ThermalPairTick& tick, const Eigen::Vector2d& rise_degC, double phi_degC) {
    return through_tick(PairModel{tick}, rise_degC, phi_degC, tick.time_s);
}

Eigen::Vector2d advance(const ThermalPair& pair, const Eigen::Vector2d& rise_degC, double phi_degC,
                        double time_s) {
    return advance(thermal_pair_tick(pair, time_s), rise_degC, phi_degC, time_s);
}

}  // namespace fidservo::plant
