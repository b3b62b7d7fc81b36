// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The model of the macro stage for identification: terminal speeds, a time constant, and two thresholds.
//
//     KV(u) = +(S + B (+(u + b) - c))  for  u >= forward threshold
//             -(S + B (-(u + b) - c))  for -u >= backward threshold,  else 0
//     tau dv/dt = KV(u) - C sgn(v) - v,   dy/dt = v
//
// S is the speed, in mm/s, that the drive would hold at c volts without friction, B its slope, b a constant
// force in volts, C = K F the speed lost to Coulomb friction. At rest the carriage stays there while |KV| <=
// C. A rig without dead zone has S = c = 0 and both thresholds 0, which leaves KV = B (u + b). Speeds are
// used as parameters instead of (K, a0, delta), because the data determine each of them separately: none
// depends on the threshold, which is only known to lie between two command levels.

namespace fidservo::calib {

struct MacroMotion {
    double speed_mm_per_s = 0.0;        ///< S
    double slope_mm_per_s_per_V = 0.0;  ///< B
    double centre_V = 0.0;              ///< c, not fitted
    double friction_mm_per_s = 0.0;     ///< C, at least 0
    double offset_V = 0.0;              ///< b
    double time_constant_s = 0.0;       ///< tau
    double forward_threshold_V = 0.0;   ///< smallest command to the right that drives
    double backward_threshold_V = 0.0;  ///< smallest command to the left that drives, as a positive number
};

/// KV(u), in mm/s.
double drive_speed_mm_per_s(const MacroMotion& motion, double command_V);

/// Position and velocity, positive to the right, in the encoder's frame.
struct MacroMotionState {
    double position_mm = 0.0;
    double velocity_mm_per_s = 0.0;
};

/// The exact solution over ticks of held commands.
class MacroPropagation {
  public:
    /// Demands a positive tick and time constant.
    MacroPropagation(const MacroMotion& motion, double tick_s);

    void advance(MacroMotionState& state, double command_V) const;

  private:
    /// Motion in which the velocity does not change sign, over less than a tick.
    void glide(MacroMotionState& state, double terminal_mm_per_s, double duration_s) const;

    MacroMotion motion_;
    double tick_s_;
    double decay_;    ///< exp(-T / tau)
    double glide_s_;  ///< tau (1 - decay): distance per unit of velocity in excess of the terminal one
};

}  // namespace fidservo::calib
