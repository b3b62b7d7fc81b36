// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

#include <numbers>

namespace fidservo::plant::effects {

namespace {

constexpr double heights[] = {1.0, 0.5, 0.25, 0.0};

constexpr EffectParameter parameters[] = {
    {"about_u_deg", "deg", -10.0, 10.0, 0.0, 0.5,
     "part of the rotation vector along the image's rows; right-handed, z towards the plate"},
    {"about_v_deg", "deg", -10.0, 10.0, 0.0, 0.5, "part along its columns"},
    parameter::shape({"axis_height", "", 0.0, 1.25, 0.0, 0.0,
                      "of what it turns about, over the plate: 0 in the plate, 1 at the camera's centre"},
                     heights),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    constexpr double rad_per_deg = std::numbers::pi / 180.0;
    plant.camera->tilt_rad += rad_per_deg * Eigen::Vector2d(values[0], values[1]);
    plant.camera->tilt_axis_height += values[2];
}

}  // namespace

extern constexpr Effect camera_tilt{
    .name = "camera_tilt",
    .block = "camera.geometry",
    .part = Part::view,
    .text =
        "The camera is turned about an axis parallel to the image plane, so that one side of the plate is "
        "nearer: P' = e + R (P - e - d), e = (0, 0, Z), then the pinhole. About an axis in the plate it "
        "still looks "
        "at the same place; about one at h times the camera's height at one that lies h Z sin(angle) aside.",
    .source =
        "Hartley, Zisserman, Multiple View Geometry, 2nd ed., 2004, ch. 8.4: a rotating camera's "
        "homography",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
