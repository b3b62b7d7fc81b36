// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"offset_V", "V", -1.0, 1.0, 0.0, 0.02, "voltage above nominal"},
    parameter::optional(
        {"shift_um", "um", -2000.0, 2000.0, 0.0, 0.0, "by which the magnet sits towards contraction"}, 2.0),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.micro->hall.mid_V += values[0];
    plant.micro->hall.centre_mm -= 1e-3 * parameters[1].acting(values[1]);
}

}  // namespace

extern constexpr Effect hall_offset{
    .name = "hall_offset",
    .block = "micro.hall",
    .part = Part::hall,
    .text = "The sensor's zero differs: V = nominal V of x + shift, + offset.",
    .source = "Ramsden, Hall-Effect Sensors, 2nd ed., 2006: quiescent output voltage",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
