// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"factor", "", 0.5, 1.5, 1.0, 1.02, "slope per nominal slope"},
    parameter::choice("about_mid", 1.0, "1: about the middle voltage; 0: about 0 V"),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    HallParameters& hall = plant.micro->hall;
    if (parameters[1].is_high(values[1]))
        hall.span_V *= values[0];
    else
        hall.adc_range_V /= values[0];
}

}  // namespace

extern constexpr Effect hall_gain{
    .name = "hall_gain",
    .block = "micro.hall",
    .part = Part::hall,
    .text =
        "The sensor's slope differs by a factor: V = mid + factor * (nominal V - mid). "
        "Or the whole voltage does, V = factor * nominal V, as of a ratiometric sensor whose supply is "
        "not the converter's reference.",
    .source = "Ramsden, Hall-Effect Sensors, 2nd ed., 2006: sensitivity spread",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
