// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"delay_ms", "ms", 0.0, 500.0, 0.0, 20.0, "from a command to its effect; need not be whole ticks"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    constexpr double s_per_ms = 1e-3;
    plant.micro->heater_delay_s += s_per_ms * values[0];
}

}  // namespace

extern constexpr Effect heater_delay{
    .name = "heater_delay",
    .block = "micro.heater",
    .part = Part::wire,
    .text =
        "The heater acts late: the voltage on it at t is the command of t - delay; before the first "
        "command, 0.",
    .source =
        "Astrom, Wittenmark, Computer-Controlled Systems, 3rd ed., 1997, ch. 2: systems with a dead "
        "time",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
