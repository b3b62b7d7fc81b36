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

}  // namespace

CameraGeometry actual_camera(const CameraGeometry& nominal, const CameraDeviation& deviation) {
    CameraGeometry actual = nominal;
    actual.focal_px *= deviation.pixel_scale;
    actual.distortion.k1 += deviation.distortion;
    if (deviation.rotation_rad == 0.0 && deviation.tilt_rad.isZero(0.0)) return actual;
    actual.rotation_rad = deviation.rotation_rad;
    actual.tilt_rad = deviation.tilt_rad;
    if (nominal.rotation_rad != 0.0 || !nominal.tilt_rad.isZero(0.0))
        set_rotation(actual, Eigen::Quaterniond(camera_from_plate(actual) * camera_from_plate(nominal)));
    return actual;
}

}  // namespace fidservo::plant
