// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

/// It settles within a run or never.
constexpr double settlings_per_s[] = {0.0, 0.1};

constexpr EffectParameter parameters[] = {
    {"rate_mV_per_s", "mV/s", -20.0, 20.0, 0.0, 1.0, "of the sensor's zero, from the start of the run"},
    parameter::optional({"settling_per_s", "1/s", 0.0, 2.0, 0.0, 0.0, "rate at which it settles"}, 0.01,
                        settlings_per_s),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    constexpr double V_per_mV = 1e-3;
    HallDisturbance& disturbance = plant.micro->hall_disturbance;
    disturbance.drift_V_per_s += V_per_mV * values[0];
    disturbance.settling_per_s = parameters[1].acting(values[1]);
}

}  // namespace

extern constexpr Effect hall_drift{
    .name = "hall_drift",
    .block = "micro.hall",
    .part = Part::hall,
    .text =
        "The sensor's zero moves with time: V = nominal V + rate t, t from the start of the run, up "
        "to 1 V either way. Where it settles as a sensor warms up, rate (1 - exp(-settling t)) / settling.",
    .source =
        "Popovic, Hall Effect Devices, 2nd ed., 2004, ch. 5: offset drift by temperature and package "
        "stress",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
