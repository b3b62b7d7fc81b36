// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/camera/camera_geometry.h"

#include "core/camera/camera_slopes.h"

#include <limits>

#include <Eigen/Geometry>

namespace fidservo {
bool looks_straight(const CameraGeometry& camera) {
    return camera.focal_ratio == 1.0 && camera.distortion.is_none() && camera.rotation_rad == 0.0 &&
           camera.tilt_rad.isZero(0.0) && camera.axis_rad.isZero(0.0);
}

Eigen::Matrix3d camera_from_plate(const CameraGeometry& camera) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(camera.rotation_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const double tilt_rad = camera.tilt_rad.norm();
    if (tilt_rad == 0.0) return turn;
    const Eigen::Vector3d axis(camera.tilt_rad.x() / tilt_rad, camera.tilt_rad.y() / tilt_rad, 0.0);
    return Eigen::AngleAxisd(tilt_rad, axis).toRotationMatrix() * turn;
}

Eigen::Vector2d project(const CameraGeometry& camera, const Eigen::Vector2d& plate_mm, double s_mm) {
    if (looks_straight(camera))
        return camera.principal_point_px + (plate_mm - Eigen::Vector2d(s_mm, 0.0)) / mm_per_px(camera);
    const Eigen::Vector3d from_camera =
        Eigen::Vector3d(plate_mm.x(), plate_mm.y(), camera.distance_mm) - s_mm * stage_axis(camera);
    const Eigen::Vector3d seen = camera_from_plate(camera) * from_camera;
    const Eigen::Vector2d pictured = picture_of(camera.distortion, seen);
    return camera.principal_point_px +
           camera.focal_px * Eigen::Vector2d(pictured.x(), camera.focal_ratio * pictured.y());
}

Eigen::Vector2d back_project(const CameraGeometry& camera, const Eigen::Vector2d& image_px, double s_mm) {
    if (looks_straight(camera))
        return (image_px - camera.principal_point_px) * mm_per_px(camera) + Eigen::Vector2d(s_mm, 0.0);
    const Eigen::Vector3d ray =
        camera_from_plate(camera).transpose() * ray_of(camera.distortion, pictured_at(camera, image_px));
    if (!(ray.z() > 0.0)) return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    const Eigen::Vector3d centre = s_mm * stage_axis(camera);
    return centre.head<2>() + (camera.distance_mm - centre.z()) / ray.z() * ray.head<2>();
}

}  // namespace fidservo
