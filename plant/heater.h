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
// This is heater_step_degC of core/micro_model.h with the exponentials computed once. A wire that exchanges
// heat with a second mass follows plant/thermal_pair.h or plant/thermal_rod.h instead; for a delayed heater
// see plant/delay_line.h.
#include "core/micro_parameters.h"
#include "plant/delay_line.h"
#include "plant/thermal_rod.h"

#include <array>
#include <optional>

namespace fidservo::plant {

/// The thermal mass of plates or a mount that the wire heats, with the parameters of plant/thermal_pair.h.
/// Without coupling there is none.
struct SecondMass {
    double coupling = 0.0;
    double tau_s = 20.0;
    double taken = 1.0;
    double heating = 1.0;
    double diffusion_s = 0.0;  ///< length^2 / diffusivity of the mass as a rod; 0: its temperature is uniform
    /// How the mass behaves where it takes less heat than it gives back: plant/thermal_pair.h.
    bool is_source = false;
};

/// The heater's parameters and constants that follow from them for one tick. Immutable.
struct Heater {
    HeaterParameters parameters;
    /// 1 - exp(-T / heating tau): fraction of the temperature difference that a tick covers.
    double heating_share;
    double cooling_share;
    double tick_s;
    ThermalPairTick pair;           ///< the equations of wire and second mass
    std::optional<ThermalRod> rod;  ///< those where the second mass conducts heat within it
    double delay_s;                 ///< time from a command to its effect
    bool has_mass;
    bool is_plain;  ///< there is neither second mass nor delay
};

struct HeaterState {
    double temp_degC;
    /// The second mass's temperatures above ambient, part by part; a mass of uniform temperature uses the
    /// first one.
    std::array<double, rod_parts> mass_rise_degC{};
    DelayLineState line = {};
};

/// Throws InputError where the parameters would let the mass give back more heat than the wire receives.
Heater make_heater(const HeaterParameters& parameters, double tick_s, const SecondMass& mass = {},
                   double delay_s = 0.0);

/// The state with everything at ambient temperature.
HeaterState start(const Heater& heater);

/// What formulas add to the heating in a tick.
struct ExtraHeat {
    double power_degC = 0.0;       ///< added to phi
    double flow_degC_per_s = 0.0;  ///< added to dT/dt
};

/// One tick under a held command in V.
void advance(const Heater& heater, HeaterState& state, double command_V, const ExtraHeat& extra = {});

}  // namespace fidservo::plant
