// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"delay_ms", "ms", 0.0, 500.0, 0.0, 30.0, "stamp after the true middle of the exposure"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    constexpr double s_per_ms = 1e-3;
    plant.camera->delay_s += s_per_ms * values[0];
}

}  // namespace

extern constexpr Effect camera_latency{
    .name = "camera_latency",
    .block = "camera.timing",
    .part = Part::view,
    .text =
        "Frame times are late by a constant: a frame whose exposure is centred at t is stamped t + delay, "
        "and arrives that much later.",
    .source =
        "Furgale, Rehder, Siegwart, Unified temporal and spatial calibration, IROS 2013: camera time offset",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
