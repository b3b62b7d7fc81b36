#pragma once
// Friction that acts on the carriage's motion, in volts, positive to the left when the carriage moves to the
// right:
//
//     g(|v|, y) = Fc + Fs exp(-|v| / vs) + Fp exp(-((y - yp) / wp)^2 / 2)     Coulomb, Stribeck, rail patch
//     F = sgn(v) g + c v                                                     c by direction
//
// At v = 0 dry friction holds whatever is not above g(0, y), or a little more: hold_V. Friction that creeps
// does not hold: with a creep speed vc, tanh(v / vc) stands for sgn(v) (Andersson et al., Tribology
// International 40, 2007).
//
// Bristles bend over a length d before they slide (Dahl 1968; in the path that is covered, as Bliman and
// Sorine 1995 write it):
//
//     F = g z + c1 (v - |v| z) + c v,     dz/dy = (1 - z sgn(v)) / d
//
// This is LuGre (Canudas de Wit et al. 1995) with sigma0 = g / d and sigma1 = c1; for a g that depends on v
// or y it differs from LuGre in that the length, not the stiffness, is constant. z follows from the way
// alone, so that no speed makes the equations stiff: from z0 at y0 the bend in direction s is
//
//     z(y) = s + (z0 - s) exp(-s (y - y0) / d)
#include <algorithm>
#include <cmath>

namespace fidservo::plant {

/// Where on the rail friction is raised, as a bell of standard deviation width_mm.
struct RailPatch {
    double level_V = 0.0;
    double centre_mm = 0.0;
    double width_mm = 1.0;
};

struct Friction {
    double coulomb_V = 0.0;
    double hold_V = 0.0;      ///< what is held at rest beyond g
    double stribeck_V = 0.0;  ///< beyond Coulomb friction, at rest
    double stribeck_mm_per_s = 1.0;
    RailPatch patch{};
    double creep_mm_per_s = 0.0;    ///< vc; 0: none, friction holds at rest
    double right_V_s_per_mm = 0.0;  ///< viscous, on motion to the right
    double left_V_s_per_mm = 0.0;
    double bristle_mm = 0.0;  ///< d; 0: rigid
    double bristle_damping_V_s_per_mm = 0.0;
};

/// Whether g can be other than 0.
inline bool is_dry(const Friction& friction) {
    return friction.coulomb_V != 0.0 || friction.stribeck_V != 0.0 || friction.patch.level_V != 0.0;
}

inline bool has_bristles(const Friction& friction) {
    return friction.bristle_mm > 0.0 && (is_dry(friction) || friction.bristle_damping_V_s_per_mm > 0.0);
}

inline bool acts(const Friction& friction) {
    return is_dry(friction) || has_bristles(friction) || friction.right_V_s_per_mm != 0.0 ||
           friction.left_V_s_per_mm != 0.0;
}

/// g(|v|, y) in V.
inline double dry_friction_V(const Friction& friction, double speed_mm_per_s, double position_mm) {
    double level_V = friction.coulomb_V;
    if (friction.stribeck_V != 0.0)
        level_V += friction.stribeck_V * std::exp(-speed_mm_per_s / friction.stribeck_mm_per_s);
    if (friction.patch.level_V != 0.0) {
        const double away = (position_mm - friction.patch.centre_mm) / friction.patch.width_mm;
        level_V += friction.patch.level_V * std::exp(-0.5 * away * away);
    }
    return level_V;
}

/// What dry friction holds at rest, in V: without bristles, which always give way a little.
inline double breakaway_V(const Friction& friction, double position_mm) {
    return friction.creep_mm_per_s > 0.0 ? 0.0 : friction.hold_V + dry_friction_V(friction, 0.0, position_mm);
}

/// F without bristles, in V, of a motion in a direction (+1 right, -1 left). A velocity against the
/// direction, as trial steps beyond a turn have, counts as 0 where F depends on speed alone.
inline double sliding_friction_V(const Friction& friction, double velocity_mm_per_s, double position_mm,
                                 double direction) {
    const double speed_mm_per_s = std::max(0.0, direction * velocity_mm_per_s);
    const double viscous = direction > 0.0 ? friction.right_V_s_per_mm : friction.left_V_s_per_mm;
    const double sign =
        friction.creep_mm_per_s > 0.0 ? std::tanh(velocity_mm_per_s / friction.creep_mm_per_s) : direction;
    return sign * dry_friction_V(friction, speed_mm_per_s, position_mm) + viscous * velocity_mm_per_s;
}

/// z after a way in one direction.
inline double bristle_bend(const Friction& friction, double bend, double way_mm, double direction) {
    return direction + (bend - direction) * std::exp(-direction * way_mm / friction.bristle_mm);
}

/// F with bristles of bend z, in V.
inline double bristle_friction_V(const Friction& friction, double velocity_mm_per_s, double position_mm,
                                 double direction, double bend) {
    const double speed_mm_per_s = direction * velocity_mm_per_s;
    const double viscous = direction > 0.0 ? friction.right_V_s_per_mm : friction.left_V_s_per_mm;
    return dry_friction_V(friction, std::max(0.0, speed_mm_per_s), position_mm) * bend +
           friction.bristle_damping_V_s_per_mm * (velocity_mm_per_s - speed_mm_per_s * bend) +
           viscous * velocity_mm_per_s;
}

}  // namespace fidservo::plant
