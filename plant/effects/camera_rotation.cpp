// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

#include <numbers>

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"angle_deg", "deg", -10.0, 10.0, 0.0, 1.0, "of the picture, from u (right) towards v (down)"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    constexpr double rad_per_deg = std::numbers::pi / 180.0;
    plant.camera->rotation_rad += rad_per_deg * values[0];
}

}  // namespace

extern constexpr Effect camera_rotation{
    .name = "camera_rotation",
    .block = "camera.geometry",
    .part = Part::view,
    .text =
        "The camera is turned about its optical axis: the picture is turned by the angle about the "
        "principal point.",
    .source =
        "Hartley, Zisserman, Multiple View Geometry, 2nd ed., 2004, ch. 6: rotation about the "
        "principal axis",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
