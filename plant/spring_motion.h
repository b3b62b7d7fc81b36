// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A motion against a spring; y is counted from where the motion begins:
//
//     v' = a - k y - b v,     y' = v,     y(0) = 0
//
// With c = b / 2 and s = c^2 - k, C = cosh(sqrt(s) t), S = sinh(sqrt(s) t) / sqrt(s), both real for any s,
//
//     y = a / k + exp(-c t) (-a / k C + (v0 - c a / k) S),     v = exp(-c t) (v0 C + (a - c v0) S)
//
// The energy v^2 / 2 + k (y - a / k)^2 / 2 never grows, so that y stays within a / k +- sqrt((a / k)^2 + v0^2
// / k).
#include "plant/friction.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace fidservo::plant {

struct SpringMotion {
    double start_mm_per_s2;   ///< a
    double stiffness_per_s2;  ///< k > 0
    double damping_per_s;     ///< b
    double start_mm_per_s;    ///< v0

    /// y in mm and v in mm/s after a time in s.
    std::pair<double, double> after(double time_s) const {
        const double c = 0.5 * damping_per_s, s = c * c - stiffness_per_s2;
        const double rate = std::sqrt(std::abs(s)), turned = rate * time_s;
        double cosine = 1.0, sine = time_s;
        if (s < 0.0) {
            cosine = std::cos(turned);
            sine = std::sin(turned) / rate;
        } else if (s > 0.0) {
            cosine = std::cosh(turned);
            sine = std::sinh(turned) / rate;
        }
        const double decay = std::exp(-c * time_s), rest_mm = start_mm_per_s2 / stiffness_per_s2;
        return {rest_mm + decay * (-rest_mm * cosine + (start_mm_per_s - c * rest_mm) * sine),
                decay * (start_mm_per_s * cosine + (start_mm_per_s2 - c * start_mm_per_s) * sine)};
    }

    /// Time in s within which the motion reverses at most once: half a period.
    double until_second_turn_s() const {
        const double c = 0.5 * damping_per_s, s = c * c - stiffness_per_s2;
        return s < 0.0 ? std::numbers::pi / std::sqrt(-s) : std::numeric_limits<double>::infinity();
    }

    /// The range within which y, in mm, stays for ever.
    std::pair<double, double> range_mm() const {
        const double rest_mm = start_mm_per_s2 / stiffness_per_s2;
        const double farthest_mm = std::hypot(rest_mm, start_mm_per_s / std::sqrt(stiffness_per_s2));
        return {rest_mm - farthest_mm, rest_mm + farthest_mm};
    }
};

/// The motion of a carriage under a held voltage with elastic bristles (plant/friction.h) bent by `bend`.
inline SpringMotion bristle_motion(const Friction& friction, double tau_s, double gain_mm_per_s_per_V,
                                   double direction, double voltage_V, double bend,
                                   double velocity_mm_per_s) {
    const double gain = gain_mm_per_s_per_V;
    const double viscous = direction > 0.0 ? friction.right_V_s_per_mm : friction.left_V_s_per_mm;
    return {gain * (voltage_V - friction.coulomb_V * bend) / tau_s,
            gain * friction.coulomb_V / (friction.bristle_mm * tau_s),
            (1.0 + gain * (friction.bristle_damping_V_s_per_mm + viscous)) / tau_s, velocity_mm_per_s};
}

}  // namespace fidservo::plant
