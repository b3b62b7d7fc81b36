// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"gradient_u", "", -0.5, 0.5, 0.0, 0.2, "relative change of the light from the centre to the right side"},
    {"gradient_v", "", -0.5, 0.5, 0.0, 0.0, "to the lower side"},
    {"vignetting", "", 0.0, 0.6, 0.0, 0.2, "loss in the corners"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.camera->light_gradient += Eigen::Vector2d(values[0], values[1]);
    plant.camera->vignetting += values[2];
}

}  // namespace

extern constexpr Effect uneven_light{
    .name = "uneven_light",
    .block = "camera.image",
    .part = Part::image,
    .text =
        "The light falls off across the image: L = (1 + gradient . (x, y)) (1 - vignetting (x^2 + "
        "y^2) / 2), x and y from -1 to 1 across the image; gradient and vignetting add to the nominal "
        "ones.",
    .source = "Goldman, Vignette and exposure calibration and compensation, IEEE Trans. PAMI 32(12), 2010",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
