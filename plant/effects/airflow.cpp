// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"factor", "", 0.2, 3.0, 1.0, 0.7, "cooling time constant per nominal one; below 1 cools faster"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.micro->heater.cooling_tau_s *= values[0];
}

}  // namespace

extern constexpr Effect airflow{
    .name = "airflow",
    .block = "micro.heater",
    .part = Part::wire,
    .text = "Moving air changes the cooling: the cooling time constant is factor * nominal.",
    .source =
        "Incropera, DeWitt, Fundamentals of Heat and Mass Transfer: forced convection, tau = m c / (h A)",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
