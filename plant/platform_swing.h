// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The flexure platform as a mass on a spring whose base is the carriage. Its deflection z from the place
// where the wire holds it:
//
//     d2z/dt2 + 2 zeta w dz/dt + w^2 z = -g a,     w = 2 pi f,  a: the carriage's acceleration
//
// Over a tick a is taken as the linear function of time that reproduces the carriage's change of velocity and
// its path; a stop at an end of travel so passes on its whole momentum. For such an a the solution is exact.
// Source: base excitation of a damped oscillator, Meirovitch, Fundamentals of Vibrations, 2001, ch. 3.
#include <Eigen/Core>

namespace fidservo::plant {

struct SwingParameters {
    double frequency_Hz = 30.0;   ///< undamped natural frequency
    double damping_ratio = 0.05;  ///< below 1
    double gain = 0.0;  ///< fraction of the platform's mass that hangs on the flexure; 0: no oscillation
};

/// The parameters and constants that follow from them for one tick. Immutable.
struct PlatformSwing {
    SwingParameters parameters;
    Eigen::Matrix2d decay;  ///< matrix exponential for the deviation from the deflection under constant jerk
    double compliance_s2;   ///< g / w^2: deflection per acceleration
    double lag_s;           ///< 2 zeta / w: delay of the deflection under constant jerk
    double tick_s;
};

/// A carriage's acceleration over a tick.
struct Shaking {
    double acceleration_mm_per_s2 = 0.0;  ///< mean over the tick
    double jerk_mm_per_s3 = 0.0;
};

/// @param way_mm  the carriage's path in the tick
/// @param before_mm_per_s, after_mm_per_s  its velocity at the tick's beginning and end
inline Shaking shaking_of(double way_mm, double before_mm_per_s, double after_mm_per_s, double tick_s) {
    const double beyond_mm = way_mm - 0.5 * (before_mm_per_s + after_mm_per_s) * tick_s;
    return {(after_mm_per_s - before_mm_per_s) / tick_s, -12.0 * beyond_mm / (tick_s * tick_s * tick_s)};
}

struct SwingState {
    double position_mm = 0.0;  ///< relative to where the wire holds the platform
    double velocity_mm_per_s = 0.0;
};

PlatformSwing make_platform_swing(const SwingParameters& parameters, double tick_s);

/// One tick.
void advance(const PlatformSwing& swing, SwingState& state, const Shaking& shaking);

}  // namespace fidservo::plant
