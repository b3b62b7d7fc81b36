// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"factor", "", 0.5, 1.5, 1.0, 1.05, "contraction per nominal contraction"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.micro->stroke_factor *= values[0];
}

}  // namespace

extern constexpr Effect stroke_change{
    .name = "stroke_change",
    .block = "micro.hysteresis",
    .part = Part::wire,
    .text = "The actuator's stroke differs by a factor: x = factor * f of the table.",
    .source =
        "Lagoudas, Shape Memory Alloys, 2008: transformation strain varies with training, load and fatigue",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
