// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Friction that acts on the carriage's motion, in volts, positive to the left when the carriage moves to the
// right:
//
//     g(|v|, y) = Fc + Fs exp(-(|v| / vs)^n) + Fp exp(-(|y - yp| / wp)^m / 2)     Coulomb, Stribeck, rail
//     patch F = sgn(v) g + c v                                                         c by direction
//
// While the drive's voltage is inside the dead zone g is larger by coasting_V, which a driven carriage does
// not feel.
//
// At v = 0 dry friction holds against forces up to g(0, y) + hold_V. Friction that creeps does not hold: with
// a creep speed vc, tanh(v / vc) stands for sgn(v) (Andersson et al., Tribology International 40, 2007).
//
// Bristles bend over a length d before they slide (Dahl 1968; in the path that is covered, as Bliman and
// Sorine 1995 write it):
//
//     F = Fc z + c1 d dz/dt + c v,     dz/dy = e / d,     e = 1 - z sgn(v) Fc / g
//
// This is LuGre (Canudas de Wit et al. 1995) with the stiffness sigma0 = Fc / d, whatever g is, and sigma1 =
// c1. LuGre's law lets a carriage drift under pulses that are too weak to break it away. Where bristles are
// springs until they slide, dz/dy = sgn(e) / d, nothing drifts (Dupont et al. 2002). z is a function of the
// path alone, so that no speed makes the equations stiff. Along a path w = s (y - y0) in direction s, on
// which g / Fc changes linearly and little from a to b, m their mean and q = w / (m d):
//
//     LuGre:    z(y) = s m + (z0 - s m) E + s (b - a) ((1 + E) / 2 - (1 - E) / q),     E = exp(-q)
//     springs:  z(y) = z0 + s w / d, no farther than to s b
#include <algorithm>
#include <cmath>
#include <optional>

namespace fidservo::plant {

/// A patch of the rail where friction is raised: a bell of standard deviation width_mm, or one with steeper
/// flanks.
struct RailPatch {
    double level_V = 0.0;
    double centre_mm = 0.0;
    double width_mm = 1.0;
    double exponent = 2.0;  ///< m >= 2; 2 is a Gaussian

    /// The patch's friction at a position, V.
    double friction_V(double position_mm) const {
        const double away = (position_mm - centre_mm) / width_mm;
        return level_V *
               std::exp(-0.5 * (exponent == 2.0 ? away * away : std::pow(std::abs(away), exponent)));
    }

    /// Whether a position is near enough to count; farther away less than exp(-32) of the level is left.
    bool reaches(double position_mm) const {
        constexpr double far_widths = 8.0;
        return level_V != 0.0 && std::abs(position_mm - centre_mm) <= far_widths * width_mm;
    }
};

struct Friction {
    double coulomb_V = 0.0;
    double coasting_V = 0.0;  ///< added to coulomb_V while the drive's voltage is inside the dead zone
    double hold_V = 0.0;      ///< force held at rest in excess of g
    double stribeck_V = 0.0;  ///< excess over Coulomb friction at rest
    double stribeck_mm_per_s = 1.0;
    double stribeck_exponent = 1.0;  ///< n: 1 an exponential, 2 a Gaussian
    RailPatch patch{};
    double creep_mm_per_s = 0.0;    ///< vc; 0: friction holds at rest
    double right_V_s_per_mm = 0.0;  ///< viscous coefficient for motion to the right
    double left_V_s_per_mm = 0.0;
    double bristle_mm = 0.0;  ///< d; 0: rigid
    double bristle_damping_V_s_per_mm = 0.0;
    bool bristles_are_springs = false;  ///< bristles are elastic until they slide, instead of LuGre's law
};

/// Whether there is dry friction: g can be other than 0.
inline bool is_dry(const Friction& friction) {
    return friction.coulomb_V != 0.0 || friction.coasting_V != 0.0 || friction.stribeck_V != 0.0 ||
           friction.patch.level_V != 0.0;
}

/// Whether bristles act. Without Coulomb friction they would have no stiffness.
inline bool has_bristles(const Friction& friction) {
    return friction.bristle_mm > 0.0 && friction.coulomb_V > 0.0;
}

inline bool acts(const Friction& friction) {
    return is_dry(friction) || friction.right_V_s_per_mm != 0.0 || friction.left_V_s_per_mm != 0.0;
}

/// The Stribeck term Fs exp(-(|v| / vs)^n), V.
inline double stribeck_friction_V(const Friction& friction, double speed_mm_per_s) {
    const double share = speed_mm_per_s / friction.stribeck_mm_per_s;
    const double n = friction.stribeck_exponent;
    const double power = n == 1.0 ? share : n == 2.0 ? share * share : std::pow(share, n);
    constexpr double next_to_nothing = 40.0;
    return power > next_to_nothing ? 0.0 : friction.stribeck_V * std::exp(-power);
}

/// Dry friction g(|v|, y), V.
/// @param coasts  whether the drive's voltage is inside the dead zone
inline double dry_friction_V(const Friction& friction, double speed_mm_per_s, double position_mm,
                             bool coasts) {
    double level_V = friction.coulomb_V;
    if (coasts) level_V += friction.coasting_V;
    if (friction.stribeck_V != 0.0) level_V += stribeck_friction_V(friction, speed_mm_per_s);
    if (friction.patch.reaches(position_mm)) level_V += friction.patch.friction_V(position_mm);
    return level_V;
}

/// The force that dry friction holds at rest, V, for friction without bristles (bristles always yield a
/// little).
/// @param coasts  whether the drive's voltage is inside the dead zone; a belt may still pull then
inline double breakaway_V(const Friction& friction, double position_mm, bool coasts) {
    return friction.creep_mm_per_s > 0.0
               ? 0.0
               : friction.hold_V + dry_friction_V(friction, 0.0, position_mm, coasts);
}

/// Friction F without bristles, V, for motion in a direction (+1 right, -1 left) where dry friction is dry_V.
inline double sliding_friction_V(const Friction& friction, double velocity_mm_per_s, double direction,
                                 double dry_V) {
    const double viscous = direction > 0.0 ? friction.right_V_s_per_mm : friction.left_V_s_per_mm;
    const double sign =
        friction.creep_mm_per_s > 0.0 ? std::tanh(velocity_mm_per_s / friction.creep_mm_per_s) : direction;
    return sign * dry_V + viscous * velocity_mm_per_s;
}

/// Whether at this speed creeping friction equals sliding friction to the last digit.
inline bool slides(const Friction& friction, double speed_mm_per_s) {
    constexpr double tanh_is_one = 19.1;
    return speed_mm_per_s >= tanh_is_one * friction.creep_mm_per_s;
}

struct Creep {
    double velocity_mm_per_s;
    /// Least slope of friction over velocity between the present velocity and the balanced one.
    double slope_V_s_per_mm;
};

/// The velocity at which creeping friction balances the pull; empty where the pull is near the force at which
/// the carriage would slide.
inline std::optional<Creep> balanced_creep(const Friction& friction, double velocity_mm_per_s,
                                           double position_mm, bool coasts, double pull_V) {
    constexpr double far_below = 0.9;
    const double dry_V = dry_friction_V(friction, std::abs(velocity_mm_per_s), position_mm, coasts);
    const double balance = pull_V / dry_V, now = std::tanh(velocity_mm_per_s / friction.creep_mm_per_s);
    if (!(std::abs(balance) <= far_below)) return std::nullopt;
    const double slope = 1.0 - std::max(balance * balance, now * now);
    return Creep{friction.creep_mm_per_s * std::atanh(balance), dry_V * slope / friction.creep_mm_per_s};
}

/// Bristles whose bend is within this of the bend at which they slide count as sliding.
inline constexpr double fully_bent_within = 1e-8;

struct BristleBend {
    double bend;     ///< z
    double bending;  ///< d dz/dy for motion in its direction: 1 for unbent bristles, 0 for sliding ones
};

/// z after a path in one direction, on which g changes from before_V to dry_V.
inline BristleBend bristle_bend(const Friction& friction, double bend, double way_mm, double direction,
                                double before_V, double dry_V) {
    const double half = 0.5, straight = 1e-3;
    if (friction.bristles_are_springs) {
        // Bristles bend up to where they slide at the present g; if they are bent further, by a friction that
        // was larger, they straighten.
        const double most = dry_V / friction.coulomb_V, before = direction * bend;
        const double sign = before <= most ? 1.0 : -1.0;
        const double bent = before + sign * direction * way_mm / friction.bristle_mm;
        if (sign * (bent - most) >= -fully_bent_within) return {direction * most, 0.0};
        return {direction * bent, sign};
    }
    const double mean = half * (before_V + dry_V) / friction.coulomb_V;
    const double ways = direction * way_mm / (mean * friction.bristle_mm);
    const double lost = -std::expm1(-ways);
    double bent = bend + (direction * mean - bend) * lost;
    if (before_V != dry_V) {
        const double share = std::abs(ways) < straight ? ways * ways / 12.0 : 1.0 - half * lost - lost / ways;
        bent += direction * (dry_V - before_V) / friction.coulomb_V * share;
    }
    return {bent, 1.0 - direction * friction.coulomb_V * bent / dry_V};
}

/// Friction F with bristles, V.
inline double bristle_friction_V(const Friction& friction, double velocity_mm_per_s, double direction,
                                 const BristleBend& bristles) {
    const double viscous = direction > 0.0 ? friction.right_V_s_per_mm : friction.left_V_s_per_mm;
    const double damping = friction.bristle_damping_V_s_per_mm * bristles.bending + viscous;
    return friction.coulomb_V * bristles.bend + damping * velocity_mm_per_s;
}

}  // namespace fidservo::plant
