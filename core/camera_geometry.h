#pragma once
// Where a plate point appears in the image, and back.
//
// Frames. Plate: x along the stage axis, positive to the right, y positive down in the image, mm. Camera
// position s = macro + micro, mm: the plate x under the optical axis. Image: u right, v down, px; pixel
// centres lie at integer coordinates. Pinhole, looking straight down from distance Z:
//
//     u = u0 + f (X - s) / Z,     v = v0 + f Y / Z
#include <Eigen/Core>

namespace fidservo {

struct CameraGeometry {
    int width_px;
    int height_px;
    double focal_px;
    Eigen::Vector2d principal_point_px;
    double distance_mm;
};

inline double mm_per_px(const CameraGeometry& camera) {
    return camera.distance_mm / camera.focal_px;
}

/// Image point in px of a plate point in mm, seen from camera position s.
inline Eigen::Vector2d project(const CameraGeometry& camera, const Eigen::Vector2d& plate_mm, double s_mm) {
    return camera.principal_point_px + (plate_mm - Eigen::Vector2d(s_mm, 0.0)) / mm_per_px(camera);
}

/// Plate point in mm of an image point in px, seen from camera position s.
inline Eigen::Vector2d back_project(const CameraGeometry& camera, const Eigen::Vector2d& image_px,
                                    double s_mm) {
    return (image_px - camera.principal_point_px) * mm_per_px(camera) + Eigen::Vector2d(s_mm, 0.0);
}

}  // namespace fidservo
