// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The macro stage as a balance of forces, with the platform's flexure on top of it.
//
//     m dv/dt = V(u + g(y)) - F(v, y) - b v,     dy/dt = v
//
// With m = tau / K and b = 1 / K forces are in volts; V is the dead zone of the rig file on the sum of the
// driving voltage u and the forces by place g; F is dry friction. The carriage sticks when its speed comes to
// zero and the forces do not exceed the friction at rest; the time of that is located within the step. At
// either end of travel it stops without rebound. Drag k v |v| and damping by a power of speed add to the
// friction.
//
// A belt divides the mass: share s is the motor's, with the driving voltage and its damping b; the rest is
// the carriage's, with its friction. They pull at each other with z / C + d dz/dt, z = motor - carriage, d =
// 2 D sqrt(s (1 - s) m / C).
//
// Play (backlash): the integrated mass is the driving part; the carriage rests until one side of the play
// pushes it.
//
// A smooth discrepancy f (departures.h) adds f(y) to g, or f(v) s or sgn(v) f(y) s to the friction, s = 1 -
// exp(-(v / v_0)^2).
//
// The flexure: q = platform's swing against the wire's end, w = dq/dt + coupling v, so that the carriage's
// acceleration is not needed and its impacts act on the platform:
//
//     dq/dt = w - coupling v,     dw/dt = -2 zeta omega dq/dt - omega^2 q
#include "core/macro_parameters.h"
#include "reference/departures.h"

namespace fidservo {
struct Rig;
}

namespace fidservo::reference {

struct CarriageModel {
    double low_mm = 0.0, high_mm = 0.0;  ///< travel of the driving part
    double inertia_V_s2_per_mm = 0.0;
    double damping_V_s_per_mm = 0.0;
    double command_limit_V = 0.0;
    DeadZone dead_zone = {};
    DriveDepartures drive = {};
    FrictionDepartures friction = {};
    MechanicsDepartures mechanics = {};
    FlexureDepartures flexure = {};
    Discrepancy discrepancy = {};
};

struct CarriageState {
    double position_mm = 0.0;
    double speed_mm_per_s = 0.0;  ///< of the driving part, where there is play
    double bristle_mm = 0.0;      ///< deflection z of the friction's bristles
    double swing_mm = 0.0;        ///< q
    double swing_mm_per_s = 0.0;  ///< w
    double stretch_mm = 0.0;      ///< z = motor - carriage, where there is a belt
    double motor_mm_per_s = 0.0;  ///< speed of the motor, where there is a belt
    double ahead_mm = 0.0;  ///< position of the driving part minus that of the carriage, where there is play
};

CarriageModel make_carriage(const Rig& rig, const Departures& departures);

/// Driving force in V for a saturated command at a place: gain, offset, forces by position and dead zone.
double driving_force_V(const CarriageModel& model, double command_V, double position_mm);

/// Moves the carriage on for h_s seconds under a held command in V.
void advance(const CarriageModel& model, CarriageState& state, double command_V, double h_s);

}  // namespace fidservo::reference
