// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"factor", "", 0.5, 1.5, 1.0, 1.1, "voltage on the motor per volt of command"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.axis.drive_gain *= values[0];
}

}  // namespace

extern constexpr Effect drive_gain{
    .name = "drive_gain",
    .block = "macro.drive",
    .part = Part::carriage,
    .text = "The amplifier's voltage differs by a factor g: w = g u, before the dead zone.",
    .source = "gain error of a linear amplifier",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
