// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"width_um", "um", 0.0, 5000.0, 0.0, 200.0, "from one side of the play to the other"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.axis.play_mm += 1e-3 * values[0];
}

}  // namespace

extern constexpr Effect backlash{
    .name = "backlash",
    .block = "macro.mechanics",
    .part = Part::carriage,
    .text =
        "Play between motor and carriage: after a turn the carriage stays, held by friction, until the motor "
        "has "
        "crossed the play. The linear encoder sits on the carriage. A run starts in the middle of the play.",
    .source = "Nordin, Gutman, Automatica 38(10), 2002: the hysteresis (friction-driven) model",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
