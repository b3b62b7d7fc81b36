// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/heater.h"

#include "core/demand.h"
#include "core/input_error.h"
#include "core/micro_model.h"
#include "core/micro_parameters.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fidservo::plant {

namespace {

/// Any part of a tick, with or without a second mass.
void heat(const Heater& heater, HeaterState& state, double phi_degC, double time_s) {
    const HeaterParameters& wire = heater.parameters;
    if (!heater.has_mass) {
        state.temp_degC = heated_degC(wire, state.temp_degC, phi_degC, time_s);
        return;
    }
    const double wire_degC = state.temp_degC - wire.ambient_degC;
    const bool is_tick = time_s == heater.tick_s;
    if (heater.rod) {
        RodRise rise_degC;
        rise_degC(0) = wire_degC;
        std::ranges::copy(state.mass_rise_degC, rise_degC.begin() + 1);
        rise_degC = is_tick ? advance(*heater.rod, rise_degC, phi_degC)
                            : advance(*heater.rod, rise_degC, phi_degC, time_s);
        state.temp_degC = wire.ambient_degC + rise_degC(0);
        std::copy(rise_degC.begin() + 1, rise_degC.end(), state.mass_rise_degC.begin());
        return;
    }
    const Eigen::Vector2d before_degC(wire_degC, state.mass_rise_degC[0]);
    const Eigen::Vector2d after_degC = is_tick ? advance(heater.pair, before_degC, phi_degC)
                                               : advance(heater.pair, before_degC, phi_degC, time_s);
    state.temp_degC = wire.ambient_degC + after_degC.x();
    state.mass_rise_degC[0] = after_degC.y();
}

}  // namespace

Heater make_heater(const HeaterParameters& parameters, double tick_s, const SecondMass& mass,
                   double delay_s) {
    FIDSERVO_DEMAND(tick_s > 0.0 && parameters.heating_tau_s > 0.0 && parameters.cooling_tau_s > 0.0);
    FIDSERVO_DEMAND(mass.coupling >= 0.0 && mass.tau_s > 0.0 && delay_s >= 0.0);
    if (mass.coupling * (1.0 - mass.taken) >= 1.0)
        throw InputError(
            "second_thermal_mass: gives back more than it takes, and heats the wire without end");
    const ThermalPair pair{parameters.heating_tau_s,
                           parameters.cooling_tau_s,
                           mass.coupling,
                           mass.tau_s,
                           mass.taken,
                           mass.heating,
                           mass.is_source};
    std::optional<ThermalRod> rod;
    if (mass.coupling > 0.0 && mass.diffusion_s > 0.0) rod = thermal_rod(pair, mass.diffusion_s, tick_s);
    return {parameters,
            -std::expm1(-tick_s / parameters.heating_tau_s),
            -std::expm1(-tick_s / parameters.cooling_tau_s),
            tick_s,
            thermal_pair_tick(pair, tick_s),
            std::move(rod),
            delay_s,
            mass.coupling > 0.0,
            mass.coupling == 0.0 && delay_s == 0.0};
}

HeaterState start(const Heater& heater) {
    HeaterState state{heater.parameters.ambient_degC};
    if (heater.delay_s > 0.0) state.line = start_delay_line(heater.delay_s, heater.tick_s);
    return state;
}

void advance(const Heater& heater, HeaterState& state, double command_V, const ExtraHeat& extra) {
    const auto phi_degC = [&](double acting_V) {
        return heater_rise_degC(heater.parameters, acting_V) + extra.power_degC;
    };
    const auto heated = [&](double acting_V, double time_s) {
        heat(heater, state, phi_degC(acting_V), time_s);
    };
    if (heater.is_plain) {
        const double way_degC = phi_degC(command_V) - (state.temp_degC - heater.parameters.ambient_degC);
        state.temp_degC += way_degC * (way_degC > 0.0 ? heater.heating_share : heater.cooling_share);
    } else if (heater.delay_s == 0.0) {
        heated(command_V, heater.tick_s);
    } else {
        pass(state.line, heater.delay_s, heater.tick_s, command_V, heated);
    }
    state.temp_degC += heater.tick_s * extra.flow_degC_per_s;
}

}  // namespace fidservo::plant
