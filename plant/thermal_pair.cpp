#include "plant/thermal_pair.h"

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

    Regime(const ThermalPair& pair, double tau_s, double phi_degC) {
        const double a = pair.coupling * tau_s / pair.cooling_tau_s, r = pair.retention;
        rates_per_s << -(1.0 + a) / tau_s, a / tau_s, r / pair.mass_tau_s, -1.0 / pair.mass_tau_s;
        const double wire_degC = phi_degC / (1.0 + a * (1.0 - r));
        equilibrium_degC = {wire_degC, r * wire_degC};
    }

    Eigen::Vector2d after(const Eigen::Vector2d& rise_degC, double time_s) const {
        const Eigen::Matrix2d& A = rates_per_s;
        const double m = 0.5 * (A(0, 0) + A(1, 1));
        const double d = std::hypot(0.5 * (A(0, 0) - A(1, 1)), std::sqrt(A(0, 1) * A(1, 0)));
        const double mean_of_decays = 0.5 * (std::exp((m + d) * time_s) + std::exp((m - d) * time_s));
        const Eigen::Vector2d deviation = rise_degC - equilibrium_degC;
        return equilibrium_degC + mean_of_decays * deviation +
               difference_of_decays(m, d, time_s) * (A * deviation - m * deviation);
    }
};

/// When the wire passes phi: bisection.
double passing_time_s(const Regime& regime, const Eigen::Vector2d& start_degC, double phi_degC, bool heating,
                      double end_s) {
    constexpr double resolution = 1e-15;
    double before_s = 0.0, after_s = end_s;
    while (after_s - before_s > resolution * end_s) {
        const double middle_s = 0.5 * (before_s + after_s);
        const bool still = (phi_degC > regime.after(start_degC, middle_s).x()) == heating;
        (still ? before_s : after_s) = middle_s;
    }
    return after_s;
}

}  // namespace

Eigen::Vector2d advance(const ThermalPair& pair, const Eigen::Vector2d& rise_degC, double phi_degC,
                        double time_s) {
    bool heating = phi_degC > rise_degC.x();
    Eigen::Vector2d now_degC = rise_degC;
    for (;;) {
        const Regime regime(pair, heating ? pair.heating_tau_s : pair.cooling_tau_s, phi_degC);
        const Eigen::Vector2d end_degC = regime.after(now_degC, time_s);
        if ((phi_degC > end_degC.x()) == heating) return end_degC;
        const double pass_s = passing_time_s(regime, now_degC, phi_degC, heating, time_s);
        now_degC = regime.after(now_degC, pass_s);
        time_s -= pass_s;
        heating = !heating;
    }
}

}  // namespace fidservo::plant
