// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"shift_degC", "degC", -30.0, 40.0, 0.0, 8.0, "room temperature above nominal"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.micro->heater.ambient_degC += values[0];
}

}  // namespace

extern constexpr Effect ambient_temperature{
    .name = "ambient_temperature",
    .block = "micro.heater",
    .part = Part::wire,
    .text = "The room is warmer or colder than nominal: Ta = nominal + shift. The wire starts at Ta.",
    .source = "Newton's law of cooling",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
