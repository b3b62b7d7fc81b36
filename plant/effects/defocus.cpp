// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

#include <cmath>

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"blur_px", "px", 0.0, 5.0, 0.0, 1.0, "standard deviation of the blur by defocus alone"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.camera->extra_blur_px = std::hypot(plant.camera->extra_blur_px, values[0]);
}

}  // namespace

extern constexpr Effect defocus{
    .name = "defocus",
    .block = "camera.image",
    .part = Part::image,
    .text = "The plate is out of focus: a Gaussian blur in addition, sigma^2 = nominal^2 + blur^2.",
    .source = "Pentland, A new sense for depth of field, IEEE Trans. PAMI 9(4), 1987: defocus as a Gaussian",
    .parameters = parameters,
    .apply = apply,
    .again = Again::adds_squares,
};

}  // namespace fidservo::plant::effects
