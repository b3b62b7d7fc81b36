// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Friction as a dead zone on the drive's voltage w (core/rig.h):
//
//     V = sgn(w) (a0 + d (|w| - w0))  for |w| >= w0, else 0
//
// A share s of it may act as dry friction on the motion instead (plant/friction.h), of level s (d w0 - a0).
// The voltage is then
//
//     V = (1 - s) V + s d w
//
// so that a driven carriage moves as before, and a coasting one is braked.
//
// The functions below take the branch by name, for a motion along which w changes.

#include "core/macro_parameters.h"

#include <cmath>
#include <limits>

namespace fidservo {

/// On which side of the dead zone a voltage lies.
enum class DeadZoneBranch {
    left = -1,   ///< below the zone: motion to the left
    inside = 0,  ///< no motion
    right = 1,   ///< above the zone: motion to the right
};

/// Whether V is a straight line through 0 for all w: there is no dead zone.
inline bool is_straight(const DeadZone& zone) {
    return zone.threshold_V == 0.0 && zone.offset_V == 0.0;
}

/// The branch that a voltage is on.
inline DeadZoneBranch dead_zone_branch(const DeadZone& zone, double drive_V) {
    if (is_straight(zone)) return DeadZoneBranch::right;
    const double size_V = std::abs(drive_V);
    if (size_V < zone.threshold_V || size_V == 0.0) return DeadZoneBranch::inside;
    return drive_V < 0.0 ? DeadZoneBranch::left : DeadZoneBranch::right;
}

/// V by the formula of a branch, which may be asked a little beyond the branch's edge.
/// @param on_motion  the share s
inline double dead_zone_V(const DeadZone& zone, DeadZoneBranch branch, double drive_V,
                          double on_motion = 0.0) {
    const double passed_V = on_motion * zone.slope * drive_V;
    if (branch == DeadZoneBranch::inside) return passed_V;
    const double side = branch == DeadZoneBranch::left ? -1.0 : 1.0;
    return passed_V +
           (1.0 - on_motion) * side * (zone.offset_V + zone.slope * (side * drive_V - zone.threshold_V));
}

/// V of a voltage w, by its branch.
inline double dead_zone_V(const DeadZone& zone, double drive_V, double on_motion = 0.0) {
    return dead_zone_V(zone, dead_zone_branch(zone, drive_V), drive_V, on_motion);
}

/// How far w is from the nearest edge of a branch, in V; negative beyond it. Infinite on a straight line.
inline double dead_zone_slack_V(const DeadZone& zone, DeadZoneBranch branch, double drive_V) {
    if (is_straight(zone)) return std::numeric_limits<double>::infinity();
    if (branch == DeadZoneBranch::inside) return zone.threshold_V - std::abs(drive_V);
    return (branch == DeadZoneBranch::left ? -drive_V : drive_V) - zone.threshold_V;
}

}  // namespace fidservo
