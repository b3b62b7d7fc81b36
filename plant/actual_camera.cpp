// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/actual_camera.h"

#include <cmath>

#include <Eigen/Geometry>

namespace fidservo::plant {
namespace {

/// A rotation as the two that a camera geometry has: about the optical axis, then about an axis in the image.
void set_rotation(CameraGeometry& camera, const Eigen::Quaterniond& turn) {
    camera.rotation_rad = 2.0 * std::atan2(turn.z(), turn.w());
    const Eigen::Quaterniond about_axis(Eigen::AngleAxisd(camera.rotation_rad, Eigen::Vector3d::UnitZ()));
    const Eigen::AngleAxisd tilt(turn * about_axis.conjugate());
    camera.tilt_rad = tilt.angle() * tilt.axis().head<2>();
}

/// The displacement d of plant/camera.h, mm: by how much the tilt displaces the point that the camera looks
/// at, in the camera's frame before the tilt.
Eigen::Vector3d aside_mm(const CameraDeviation& deviation, double distance_mm) {
    const double angle = deviation.tilt_rad.norm();
    if (angle == 0.0) return Eigen::Vector3d::Zero();
    const Eigen::Vector2d axis = deviation.tilt_rad / angle;
    return deviation.tilt_axis_height * distance_mm *
           Eigen::Vector3d(-axis.y() * std::sin(angle), axis.x() * std::sin(angle), std::cos(angle) - 1.0);
}

}  // namespace

ActualCamera actual_camera(const CameraGeometry& nominal, const CameraDeviation& deviation) {
    ActualCamera actual{nominal};
    CameraGeometry& camera = actual.geometry;
    camera.focal_px *= deviation.pixel_scale;
    camera.distortion.k1 += deviation.distortion;
    actual.foot_mm = deviation.offset_mm;
    if (deviation.rotation_rad == 0.0 && deviation.tilt_rad.isZero(0.0)) return actual;
    camera.rotation_rad = 0.0;
    camera.tilt_rad = deviation.tilt_rad;
    const Eigen::Matrix3d tilt = camera_from_plate(camera);
    camera.rotation_rad = deviation.rotation_rad;
    if (nominal.rotation_rad != 0.0 || !nominal.tilt_rad.isZero(0.0))
        set_rotation(camera, Eigen::Quaterniond(camera_from_plate(camera) * camera_from_plate(nominal)));
    const Eigen::Vector3d to_plate_mm(0.0, 0.0, nominal.distance_mm);
    const Eigen::Vector3d way_mm =
        camera_from_plate(camera).transpose() *
        (tilt * (to_plate_mm + aside_mm(deviation, nominal.distance_mm)) - to_plate_mm);
    actual.foot_mm += way_mm.head<2>();
    camera.distance_mm -= way_mm.z();
    return actual;
}

}  // namespace fidservo::plant
