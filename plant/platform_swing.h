#pragma once
// The flexure platform as a mass on a spring, shaken by the carriage that carries it. Its deflection z,
// beside where the wire holds it:
//
//     d2z/dt2 + 2 zeta w dz/dt + w^2 z = -g a,     w = 2 pi f,  a: the carriage's acceleration
//
// a is taken as constant over a tick (the carriage's change of velocity by the tick's length, so that a stop
// at an end of travel gives its whole momentum); the solution is then exact.
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
    Eigen::Matrix2d decay;  ///< of the deviation from the deflection under constant acceleration
    double compliance_s2;   ///< g / w^2: deflection per acceleration
};

struct SwingState {
    double position_mm = 0.0;  ///< relative to where the wire holds the platform
    double velocity_mm_per_s = 0.0;
};

PlatformSwing make_platform_swing(const SwingParameters& parameters, double tick_s);

/// One tick under a carriage acceleration.
void advance(const PlatformSwing& swing, SwingState& state, double acceleration_mm_per_s2);

}  // namespace fidservo::plant
