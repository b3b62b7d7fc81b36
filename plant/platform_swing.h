// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The flexure platform as a mass on a spring, shaken by the carriage that carries it. Its deflection z,
// beside where the wire holds it:
//
//     d2z/dt2 + 2 zeta w dz/dt + w^2 z = -g a,     w = 2 pi f,  a: the carriage's acceleration
//
// a is taken as linear over a tick, such that it gives the carriage's change of velocity and its way: a stop
// at an end of travel gives its whole momentum when it happens. The solution is then exact.
// Source: base excitation of a damped oscillator, Meirovitch, Fundamentals of Vibrations, 2001, ch. 3.
#include <Eigen/Core>

namespace fidservo::plant {

struct SwingParameters {
    double frequency_Hz = 30.0;   ///< undamped
    double damping_ratio = 0.05;  ///< below 1
    double gain = 0.0;            ///< 1: the platform's whole mass hangs on the flexure; 0: no swing
};

/// Parameters and what follows from them for one tick. Immutable.
struct PlatformSwing {
    SwingParameters parameters;
    Eigen::Matrix2d decay;  ///< of the deviation from the deflection under constant jerk
    double compliance_s2;   ///< g / w^2: deflection per acceleration
    double lag_s;           ///< 2 zeta / w: by which the deflection under constant jerk is late
    double tick_s;
};

/// A carriage's acceleration over a tick.
struct Shaking {
    double acceleration_mm_per_s2 = 0.0;  ///< mean
    double jerk_mm_per_s3 = 0.0;
};

/// @param way_mm, before_mm_per_s, after_mm_per_s  of the carriage in a tick, and before and after it
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
