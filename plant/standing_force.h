#pragma once
// Forces by position that a carriage at rest feels too, in volts to the right. They add to the drive's
// voltage before the dead zone, so that friction holds them while the carriage stands.
//
//     f(y) = A sin(2 pi y / p + phase) - k (y - y0)          cogging and the spring of the cable harness
#include <cmath>
#include <numbers>

namespace fidservo::plant {

struct StandingForce {
    double cogging_V = 0.0;
    double cogging_period_mm = 1.0;
    double cogging_phase_rad = 0.0;
    double cable_V_per_mm = 0.0;
    double cable_centre_mm = 0.0;
};

inline bool acts(const StandingForce& force) {
    return force.cogging_V != 0.0 || force.cable_V_per_mm != 0.0;
}

/// f(y) in V, to the right.
inline double standing_force_V(const StandingForce& force, double position_mm) {
    double sum_V = -force.cable_V_per_mm * (position_mm - force.cable_centre_mm);
    if (force.cogging_V != 0.0)
        sum_V += force.cogging_V * std::sin(2.0 * std::numbers::pi * position_mm / force.cogging_period_mm +
                                            force.cogging_phase_rad);
    return sum_V;
}

}  // namespace fidservo::plant
