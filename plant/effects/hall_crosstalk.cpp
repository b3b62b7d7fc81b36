// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"leak_mV_per_V", "mV/V", -50.0, 50.0, 0.0, 4.0,
     "voltage on the sensor's line per volt of the macro drive"},
    parameter::optional(
        {"lag_ms", "ms", 0.0, 50.0, 0.0, 0.0, "time constant with which it follows the drive"}, 0.2),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    constexpr double V_per_mV = 1e-3, s_per_ms = 1e-3;
    plant.micro->hall_disturbance.leak_V_per_V += V_per_mV * values[0];
    plant.micro->hall_disturbance.leak_lag_s = s_per_ms * parameters[1].acting(values[1]);
}

}  // namespace

extern constexpr Effect hall_crosstalk{
    .name = "hall_crosstalk",
    .block = "micro.hall",
    .part = Part::hall,
    .text =
        "The macro drive's voltage u leaks into the reading: V = nominal V + leak u, u as it stood on "
        "the drive up to the sampling instant, or as a filter on the sensor's line lets it through.",
    .source = "Ott, Electromagnetic Compatibility Engineering, 2009, ch. 2 and 3: common impedance coupling",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
