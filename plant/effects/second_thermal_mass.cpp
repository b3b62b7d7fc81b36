// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

#include <algorithm>

namespace fidservo::plant::effects {

namespace {

constexpr double taus_s[] = {8.0, 40.0}, all_or_nothing[] = {1.0, 0.0};

constexpr EffectParameter parameters[] = {
    {"conductance", "", 0.0, 5.0, 0.0, 0.25, "from the wire to the mass, per that to the room"},
    parameter::shape(
        {"mass_tau_s", "s", 1.0, 1000.0, 20.0, 20.0, "the mass's heat capacity over that conductance"},
        taus_s),
    parameter::shape(
        {"taken", "", 0.0, 20.0, 1.0, 1.0,
         "what the mass takes per what it gives back; 1: it loses heat to the wire only; 0: it is the wire's "
         "surroundings"},
        all_or_nothing),
    parameter::optional(
        {"heating", "", 1.0, 2.6, 1.0, 1.0, "conductance while the wire heats, per that while it cools"},
        0.02),
    parameter::optional({"diffusion_s", "s", 0.0, 10.0, 0.0, 0.0,
                         "the mass's length^2 over its diffusivity; 0: of one temperature"},
                        0.25),
    parameter::choice(
        "source", 0.0,
        "1: what it gives back and has not taken heats the wire; 0: it warms the wire's surroundings"),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    const double lost = std::max(1.0, values[2]);  // by the mass, to the room too, per what it gives back
    plant.micro->mass = {values[0] / lost,
                         values[1] / lost,
                         values[2],
                         parameters[3].acting(values[3]),
                         parameters[4].acting(values[4]),
                         parameters[5].is_high(values[5])};
}

}  // namespace

extern constexpr Effect second_thermal_mass{
    .name = "second_thermal_mass",
    .block = "micro.heater",
    .part = Part::wire,
    .text =
        "Plates or the mount store heat and slow the cooling later on. With q, m the rise of wire and "
        "mass above the room: dq/dt = (phi - q) / tau - conductance / tau_c (q - m), mass_tau dm/dt = "
        "q - m - (taken - 1) m; tau is the heating time constant while phi > q, else the cooling one, tau_c. "
        "Below 1, what is not taken warms the wire's surroundings, or heats the wire (plant/thermal_pair.h). "
        "A mass that "
        "conducts is a rod of three parts (plant/thermal_rod.h).",
    .source =
        "Incropera, DeWitt, Fundamentals of Heat and Mass Transfer, 6th ed., 2007, ch. 5: two lumped "
        "capacitances",
    .parameters = parameters,
    .apply = apply,
    .again = Again::replaces,
};

}  // namespace fidservo::plant::effects
