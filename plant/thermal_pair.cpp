#include "plant/thermal_pair.h"

#include "plant/thermal_regimes.h"

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

/// One regime: the rates of the deviation from the equilibrium.
struct Regime {
    Eigen::Matrix2d rates_per_s;
    Eigen::Vector2d equilibrium_degC;

    Regime(const ThermalPair& pair, bool heating, double phi_degC) {
        const double tau_s = heating ? pair.heating_tau_s : pair.cooling_tau_s;
        const double s = pair.surrounding(), p = std::max(1.0, pair.taken);
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

    Eigen::Vector2d after(const Eigen::Vector2d& rise_degC, double time_s) const {
        return equilibrium_degC + decay(time_s) * (rise_degC - equilibrium_degC);
    }

    Eigen::Vector2d per_s(const Eigen::Vector2d& rise_degC) const {
        return rates_per_s * (rise_degC - equilibrium_degC);
    }
};

struct Model {
    const ThermalPair& pair;

    double above_surroundings(const Eigen::Vector2d& rise_degC) const {
        return rise_degC.x() - pair.surrounding() * rise_degC.y();
    }
    Regime regime(bool heating, double phi_degC) const { return {pair, heating, phi_degC}; }
};

}  // namespace

double ThermalPair::surrounding() const {
    return coupling * std::max(0.0, 1.0 - taken);
}

Eigen::Vector2d advance(const ThermalPair& pair, const Eigen::Vector2d& rise_degC, double phi_degC,
                        double time_s) {
    return through_regimes(Model{pair}, rise_degC, phi_degC, time_s);
}

ThermalPairTick thermal_pair_tick(const ThermalPair& pair, double time_s) {
    return {pair, time_s, Regime(pair, true, 0.0).decay(time_s), Regime(pair, false, 0.0).decay(time_s)};
}

Eigen::Vector2d advance(const ThermalPairTick& tick, const Eigen::Vector2d& rise_degC, double phi_degC) {
    return through_tick(Model{tick.pair}, rise_degC, phi_degC, tick.time_s,
                        [&](bool heating) -> const Eigen::Matrix2d& {
                            return heating ? tick.heating_decay : tick.cooling_decay;
                        });
}

}  // namespace fidservo::plant
