// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"k1", "", -2.0, 2.0, 0.0, -0.3, "per squared focal length; below 0 barrel, above 0 pincushion"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.camera->distortion += values[0];
}

}  // namespace

extern constexpr Effect lens_distortion{
    .name = "lens_distortion",
    .block = "camera.geometry",
    .part = Part::view,
    .text =
        "Radial distortion: a point at r (in focal lengths from the optical axis) is seen at r (1 + "
        "k1 r^2).",
    .source = "Brown, Close-range camera calibration, Photogrammetric Engineering 37(8), 1971",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
