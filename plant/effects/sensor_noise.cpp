// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

#include <cmath>

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"read_noise_e", "e-", 0.0, 300.0, 0.0, 40.0, "r.m.s., in addition"},
    {"gain_spread", "", 0.0, 0.1, 0.0, 0.0, "standard deviation of the pixels' fixed gains"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    CameraDeviation& camera = *plant.camera;
    camera.extra_read_noise_e = std::hypot(camera.extra_read_noise_e, values[0]);
    camera.gain_spread = std::hypot(camera.gain_spread, values[1]);
}

}  // namespace

extern constexpr Effect sensor_noise{
    .name = "sensor_noise",
    .block = "camera.image",
    .part = Part::image,
    .text =
        "The sensor is noisier: read noise^2 = nominal^2 + read_noise^2 electrons, and each pixel has "
        "its own fixed gain 1 + gain_spread z.",
    .source = "EMVA Standard 1288, Release 4.0, 2021: temporal dark noise, photo response non-uniformity",
    .parameters = parameters,
    .apply = apply,
    .again = Again::adds_squares,
};

}  // namespace fidservo::plant::effects
