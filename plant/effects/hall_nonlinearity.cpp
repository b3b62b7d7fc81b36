// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"cubic_shift", "", -0.3, 0.3, 0.0, 0.03, "added to the curve's cubic coefficient"},
    parameter::choice("ends_stay", 1.0, "1: the ends of the range stay; 0: the slope in its middle"),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    HallParameters& hall = plant.micro->hall;
    hall.cubic += values[0];
    if (parameters[1].is_high(values[1])) return;
    hall.span_V *= 1.0 - values[0];
    hall.cubic /= 1.0 - values[0];
}

}  // namespace

extern constexpr Effect hall_nonlinearity{
    .name = "hall_nonlinearity",
    .block = "micro.hall",
    .part = Part::hall,
    .text =
        "The sensor's curve is more or less S-shaped: V = mid + span s (1 + (nominal cubic + shift) (1 - "
        "s^2)); centre and ends of the range stay. Or V = nominal V - span shift s^3: centre and slope there "
        "stay.",
    .source = "Ramsden, Hall-Effect Sensors, 2nd ed., 2006: non-linearity of a sliding magnet's field",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
