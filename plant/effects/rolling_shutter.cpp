// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"readout_ms", "ms", -20.0, 20.0, 0.0, 10.0,
     "from the first row's exposure to the last one's; below 0: upwards"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    constexpr double s_per_ms = 1e-3;
    plant.camera->readout_s += s_per_ms * values[0];
}

}  // namespace

extern constexpr Effect rolling_shutter{
    .name = "rolling_shutter",
    .block = "camera.image",
    .part = Part::shutter,
    .text =
        "Rows are exposed one after the other: row v at t + readout (v / (height - 1) - 1/2), t the "
        "frame's time. What moves is sheared.",
    .source =
        "Liang, Chang, Chen, Analysis and compensation of rolling shutter effect, IEEE Trans. Image "
        "Processing 17(8), 2008",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
