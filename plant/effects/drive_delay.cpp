// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"delay_ms", "ms", 0.0, 50.0, 0.0, 3.0, "from the command to its effect"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.axis.delay_s += 1e-3 * values[0];
}

}  // namespace

extern constexpr Effect drive_delay{
    .name = "drive_delay",
    .block = "macro.drive",
    .part = Part::carriage,
    .text = "The drive acts late, by any time: w(t) = u(t - delay).",
    .source = "Ljung, System Identification, 2nd ed., 1999: dead time, not rounded to ticks",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
