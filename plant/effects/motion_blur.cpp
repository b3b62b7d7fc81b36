// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"extra_exposure_ms", "ms", 0.0, 15.0, 0.0, 5.0, "beyond the nominal exposure; its middle stays"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    constexpr double s_per_ms = 1e-3;
    plant.camera->extra_exposure_s += s_per_ms * values[0];
}

}  // namespace

extern constexpr Effect motion_blur{
    .name = "motion_blur",
    .block = "camera.image",
    .part = Part::exposure,
    .text =
        "Frames are exposed for longer, at the same brightness: what moves is the mean over its way "
        "during the exposure.",
    .source = "Potmesil, Chakravarty, Modeling motion blur in computer-generated images, SIGGRAPH 1983",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
