// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Between motor and carriage: a belt that stretches, and play where it holds the carriage.
//
// Belt. The moving mass is a motor's (share m) and a carriage's (1 - m), joined by a damped spring. The
// motor's voltage and its back-EMF act on the motor, friction acts on the carriage. In units of the axis
// equation tau dv/dt = K (V - F) - v, with the belt's force q in mm/s and s = motor - carriage:
//
//     m tau dv_m/dt       = K V - v_m - q
//     (1 - m) tau dv/dt   = q - K F
//     q = K s / C + 2 D w m (1 - m) tau ds/dt,     w^2 = K / (C m (1 - m) tau)
//
// C is the stretch per volt of force, w the natural frequency of the two masses against each other and D its
// damping ratio. Without friction both masses move on average like the stiff axis.
//
// Play. The carriage is carried along once the play is crossed, and stays where it is until then, as friction
// holds it (the play operator; Nordin and Gutman, Automatica 38, 2002, "hysteresis model"). Mass and friction
// are assigned to the driving part; the play is assumed to be small.
#include <algorithm>
#include <cmath>

namespace fidservo::plant {

/// Below this compliance a belt counts as stiff: at the largest force it would stretch by less than a
/// hundredth of a count (of 50 um).
constexpr double least_compliance_mm_per_V = 1e-4;

struct Belt {
    double compliance_mm_per_V = 0.0;  ///< 0: stiff
    double damping_ratio = 0.05;
    double motor_share = 0.5;  ///< the motor's fraction of the moving mass
};

/// Stiffness and damping of the belt's force q for an axis, in mm/s per mm and in mm/s per mm/s.
struct BeltForce {
    double per_mm = 0.0;
    double per_mm_per_s = 0.0;
};

inline double natural_frequency_rad_per_s(const Belt& belt, double gain_mm_per_s_per_V,
                                          double time_constant_s) {
    const double share = belt.motor_share * (1.0 - belt.motor_share);
    return std::sqrt(gain_mm_per_s_per_V / (belt.compliance_mm_per_V * share * time_constant_s));
}

inline BeltForce belt_force(const Belt& belt, double gain_mm_per_s_per_V, double time_constant_s) {
    const double share = belt.motor_share * (1.0 - belt.motor_share);
    return {gain_mm_per_s_per_V / belt.compliance_mm_per_V,
            2.0 * belt.damping_ratio *
                natural_frequency_rad_per_s(belt, gain_mm_per_s_per_V, time_constant_s) * share *
                time_constant_s};
}

/// The play operator: the carriage's position for a position of the driving part.
inline double carried_mm(double carriage_mm, double driven_mm, double play_mm) {
    return std::clamp(carriage_mm, driven_mm - 0.5 * play_mm, driven_mm + 0.5 * play_mm);
}

}  // namespace fidservo::plant
