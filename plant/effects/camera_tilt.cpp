#include "plant/effects/effect.h"

#include <cmath>
#include <numbers>

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"angle_deg", "deg", -3.0, 3.0, 0.0, 0.5,
     "about the axis; the axis' right-hand rule with z towards the plate"},
    {"axis_deg", "deg", -180.0, 180.0, 0.0, 0.0, "direction of the axis in the image, from u towards v"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    constexpr double rad_per_deg = std::numbers::pi / 180.0;
    const double axis_rad = rad_per_deg * values[1];
    plant.camera->tilt_rad +=
        rad_per_deg * values[0] * Eigen::Vector2d(std::cos(axis_rad), std::sin(axis_rad));
}

}  // namespace

extern constexpr Effect camera_tilt{
    .name = "camera_tilt",
    .block = "camera.geometry",
    .text =
        "The camera is turned about an axis in the image plane through its centre of projection: what "
        "is seen moves by f tan(angle) and one side of the plate is nearer. P' = R P, then the "
        "pinhole.",
    .source =
        "Hartley, Zisserman, Multiple View Geometry, 2nd ed., 2004, ch. 8.4: a rotating camera's "
        "homography",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
