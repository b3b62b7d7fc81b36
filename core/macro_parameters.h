// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The macro stage of a rig file (assets/rig.yaml), checked, in memory. docs/notation.md states the equations.
#include <optional>

namespace fidservo {

/// Friction as a dead zone on the saturated command u: the effective voltage is
/// sgn(u) (offset_V + slope (|u| - threshold_V)) for |u| >= threshold_V, else 0.
struct DeadZone {
    double threshold_V = 0.0;  ///< a0: the smallest voltage that moves the carriage
    double offset_V = 0.0;     ///< a0: effective voltage just beyond the threshold
    double slope = 1.0;        ///< d: effective voltage gained per volt beyond the threshold
};

/// The nonlinear PD: u = e0 e[k] + e1 e[k-1] with the error e in counts; then friction_V is added with the
/// sign of u.
struct PdGains {
    double e0_V_per_count;  ///< gain of this tick's error
    double e1_V_per_count;  ///< gain of the last tick's error
    double friction_V;      ///< added with the command's sign
};

/// The benchmark PID: u = kp e + ki T sum(e) + kd (e[k] - e[k-1]) / T, e in counts.
struct PidGains {
    double kp_V_per_count;    ///< gain of the error
    double ki_V_per_count_s;  ///< gain of the error's integral
    double kd_V_s_per_count;  ///< gain of the error's rate
};

/// The macro stage as its rig file describes it.
struct MacroParameters {
    double low_mm;                        ///< lower end of the travel
    double high_mm;                       ///< upper end of the travel
    double command_limit_V;               ///< largest command in either direction
    double velocity_gain_mm_per_s_per_V;  ///< steady speed per effective volt
    double velocity_pole;                 ///< factor by which the velocity decays in a tick
    DeadZone dead_zone;                   ///< Coulomb friction, as a dead zone of the voltage
    double encoder_resolution_mm;         ///< mm per count
    std::optional<PdGains> pd;            ///< empty: the rig has no such controller
    std::optional<PidGains> pid;          ///< empty: the rig has no such controller
};

}  // namespace fidservo
