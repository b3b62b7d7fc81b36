// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"mass_factor", "", 0.3, 5.0, 1.0, 1.2, "moving mass per nominal mass"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.axis.time_constant_s *= values[0];
}

}  // namespace

extern constexpr Effect payload{
    .name = "payload",
    .block = "macro.mechanics",
    .part = Part::carriage,
    .text =
        "More or less moving mass m: the time constant m / (damping) differs by a factor, the gain does not.",
    .source = "Newton's law for the motor's first-order velocity model",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
