#include "plant/effects/effect.h"

#include <numbers>

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"about_u_deg", "deg", -10.0, 10.0, 0.0, 0.5,
     "part of the rotation vector along the image's rows; right-handed, z towards the plate"},
    {"about_v_deg", "deg", -10.0, 10.0, 0.0, 0.5, "part along its columns"},
    {"aside_u_mm", "mm", -4.0, 4.0, 0.0, 0.2,
     "how far what it looks at lies aside on the plate, along the image's rows: 0 where the axis is in the "
     "plate"},
    {"aside_v_mm", "mm", -4.0, 4.0, 0.0, 0.2, "the same along its columns"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    constexpr double rad_per_deg = std::numbers::pi / 180.0;
    plant.camera->tilt_rad += rad_per_deg * Eigen::Vector2d(values[0], values[1]);
    plant.camera->aside_mm += Eigen::Vector2d(values[2], values[3]);
}

}  // namespace

extern constexpr Effect camera_tilt{
    .name = "camera_tilt",
    .block = "camera.geometry",
    .text =
        "The camera is turned about an axis parallel to the image plane, so that one side of the plate is "
        "nearer: P' = e + R (P - e - d), e = (0, 0, Z), then the pinhole. About an axis in the plate it "
        "still "
        "looks at the same place; about its own centre at one that lies d = Z sin(angle) aside.",
    .source =
        "Hartley, Zisserman, Multiple View Geometry, 2nd ed., 2004, ch. 8.4: a rotating camera's "
        "homography",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
