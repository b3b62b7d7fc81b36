// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"factor", "", 0.3, 3.0, 1.0, 1.3, "heating time constant per nominal one; above 1 heats slower"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.micro->heater.heating_tau_s *= values[0];
}

}  // namespace

extern constexpr Effect heating_lag{
    .name = "heating_lag",
    .block = "micro.heater",
    .part = Part::wire,
    .text =
        "The wire heats more slowly or faster: the heating time constant is factor * nominal; where "
        "it settles and how it cools stay.",
    .source =
        "Incropera, DeWitt, Fundamentals of Heat and Mass Transfer, 6th ed., 2007, ch. 5: lumped "
        "capacitance; Lagoudas (ed.), Shape Memory Alloys, 2008, ch. 1: latent heat of the "
        "transformation adds to it",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
