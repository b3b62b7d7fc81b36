// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"factor", "", 0.8, 1.25, 1.0, 1.01, "length in the image per nominal one"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.camera->pixel_scale *= values[0];
}

}  // namespace

extern constexpr Effect pixel_scale{
    .name = "pixel_scale",
    .block = "camera.geometry",
    .part = Part::view,
    .text =
        "Focal length or distance differs: lengths in the image are factor * nominal, about the "
        "principal point.",
    .source =
        "Hartley, Zisserman, Multiple View Geometry, 2nd ed., 2004, ch. 6: f / Z of the pinhole "
        "camera",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
