#pragma once
// The wire's temperature T under the heater's voltage c:
//
//     phi(c) = gain (min(c, limit) - onset)  for c > onset, else 0          degC above ambient at last
//     dT/dt  = (phi - (T - Ta)) / tau,   tau = heating tau while phi > T - Ta, else cooling tau
//
// phi is held over a tick, and T - Ta approaches it without crossing it: whether the wire heats or cools
// cannot change within a tick, and an exponential with one tau is the exact solution.
//
// This is heater_step_degC of core/micro_model.h with the exponentials taken once.
#include "core/rig.h"

namespace fidservo::plant {

/// Parameters and what follows from them for one tick. Immutable.
struct Heater {
    HeaterParameters parameters;
    double heating_share;  ///< 1 - exp(-T / heating tau): the part of the way to phi that a tick covers
    double cooling_share;
};

struct HeaterState {
    double temp_degC;
};

Heater make_heater(const HeaterParameters& parameters, double tick_s);

/// One tick under a held command in V.
void advance(const Heater& heater, HeaterState& state, double command_V);

}  // namespace fidservo::plant
