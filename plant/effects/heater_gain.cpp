// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"factor", "", 0.5, 1.5, 1.0, 1.05, "heating per nominal heating"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.micro->heater.gain_degC_per_V *= values[0];
}

}  // namespace

extern constexpr Effect heater_gain{
    .name = "heater_gain",
    .block = "micro.heater",
    .part = Part::wire,
    .text = "The electrical power differs by a factor: phi = factor * nominal phi.",
    .source = "Joule heating with another wire resistance or supply",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
