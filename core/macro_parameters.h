#pragma once
// The macro stage of a rig file (assets/rig.yaml), checked, in memory. docs/notation.md states the equations.
#include <optional>

namespace fidservo {

/// Friction as a dead zone on the saturated command u: the effective voltage is
/// sgn(u) (offset_V + slope (|u| - threshold_V)) for |u| >= threshold_V, else 0.
struct DeadZone {
    double threshold_V = 0.0;
    double offset_V = 0.0;
    double slope = 1.0;
};

/// u = e0 e[k] + e1 e[k-1], e in counts; then friction_V is added with the sign of u.
struct PdGains {
    double e0_V_per_count;
    double e1_V_per_count;
    double friction_V;
};

/// The benchmark controller u = kp e + ki T sum(e) + kd (e[k] - e[k-1]) / T, e in counts.
struct PidGains {
    double kp_V_per_count;
    double ki_V_per_count_s;
    double kd_V_s_per_count;
};

struct MacroParameters {
    double low_mm;  ///< travel
    double high_mm;
    double command_limit_V;
    double velocity_gain_mm_per_s_per_V;
    double velocity_pole;  ///< per tick
    DeadZone dead_zone;
    double encoder_resolution_mm;
    std::optional<PdGains> pd;
    std::optional<PidGains> pid;
};

}  // namespace fidservo
