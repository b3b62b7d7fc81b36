// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"skew_ppm", "ppm", -5000.0, 5000.0, 0.0, 200.0, "camera seconds in excess per second"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    constexpr double per_ppm = 1e-6;
    plant.camera->clock_rate *= 1.0 + per_ppm * values[0];
}

}  // namespace

extern constexpr Effect clock_skew{
    .name = "clock_skew",
    .block = "camera.timing",
    .part = Part::view,
    .text =
        "The camera's clock runs at another rate, c(t) = (1 + skew) t: it takes its frames by it and "
        "stamps them with it. A frame stamped c was exposed at c / (1 + skew).",
    .source = "Mills, Computer Network Time Synchronization, 2nd ed., 2011, ch. 1: clock skew",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
