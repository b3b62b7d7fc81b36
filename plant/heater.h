// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The wire's temperature T under the heater's voltage c:
//
//     phi(c) = gain (min(c, limit) - onset)  for c > onset, else 0          degC above ambient at last
//     dT/dt  = (phi - (T - Ta)) / tau,   tau = heating tau while phi > T - Ta, else cooling tau
//
// phi is held over a tick, and T - Ta approaches it without crossing it: whether the wire heats or cools
// cannot change within a tick, and an exponential with one tau is the exact solution.
//
// This is heater_step_degC of core/micro_model.h with the exponentials taken once. A wire that shares its
// heat with a second mass follows plant/thermal_pair.h instead, or plant/thermal_rod.h; a heater that acts
// late, plant/delay_line.h.
#include "core/micro_parameters.h"
#include "plant/delay_line.h"
#include "plant/thermal_rod.h"

#include <array>
#include <optional>

namespace fidservo::plant {

/// Plates or a mount that the wire warms: plant/thermal_pair.h. Without coupling there is none.
struct SecondMass {
    double coupling = 0.0;
    double tau_s = 20.0;
    double taken = 1.0;
    double heating = 1.0;
    double diffusion_s = 0.0;  ///< 0: of one temperature
    bool is_source = false;    ///< where it takes less than it gives back: plant/thermal_pair.h
};

/// Parameters and what follows from them for one tick. Immutable.
struct Heater {
    HeaterParameters parameters;
    double heating_share;  ///< 1 - exp(-T / heating tau): the part of the way to phi that a tick covers
    double cooling_share;
    double tick_s;
    ThermalPairTick pair;           ///< of wire and second mass
    std::optional<ThermalRod> rod;  ///< the same where the mass conducts
    double delay_s;                 ///< from a command to its effect
    bool has_mass;
    bool is_plain;  ///< neither second mass nor delay
};

struct HeaterState {
    double temp_degC;
    /// Of the second mass above ambient, part by part; of a mass of one temperature the first one.
    std::array<double, rod_parts> mass_rise_degC{};
    DelayLineState line = {};
};

/// Throws InputError where the mass would give back more than heats the wire.
Heater make_heater(const HeaterParameters& parameters, double tick_s, const SecondMass& mass = {},
                   double delay_s = 0.0);

/// All at ambient temperature.
HeaterState start(const Heater& heater);

/// What formulas add to the heating during a tick.
struct ExtraHeat {
    double power_degC = 0.0;       ///< of phi
    double flow_degC_per_s = 0.0;  ///< of dT/dt
};

/// One tick under a held command in V.
void advance(const Heater& heater, HeaterState& state, double command_V, const ExtraHeat& extra = {});

}  // namespace fidservo::plant
