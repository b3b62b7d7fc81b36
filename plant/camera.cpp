#include "plant/camera.h"

#include <cmath>

#include <Eigen/Geometry>

namespace fidservo::plant {

namespace {

/// r with r (1 + k r^2) = distorted.
double undistorted(double distorted, double k) {
    double r = distorted;
    constexpr int enough = 8;  // quadratic from an error of some 1 %
    for (int i = 0; i < enough; ++i) r -= (r * (1.0 + k * r * r) - distorted) / (1.0 + 3.0 * k * r * r);
    return r;
}

}  // namespace

CameraOptics make_camera_optics(const CameraGeometry& nominal, const CameraDeviation& deviation) {
    const double tilt_rad = deviation.tilt_rad.norm();
    const bool warps = tilt_rad != 0.0 || deviation.distortion != 0.0;
    const bool straight = !warps && deviation.rotation_rad == 0.0 && deviation.pixel_scale == 1.0;
    Eigen::Matrix3d turn = Eigen::AngleAxisd(deviation.rotation_rad, Eigen::Vector3d::UnitZ()).matrix();
    if (tilt_rad != 0.0) {
        const Eigen::Vector3d axis(deviation.tilt_rad.x() / tilt_rad, deviation.tilt_rad.y() / tilt_rad, 0.0);
        turn = Eigen::AngleAxisd(tilt_rad, axis).matrix() * turn;
    }
    return {nominal, deviation.pixel_scale, deviation.rotation_rad, warps, straight,
            turn,    deviation.distortion};
}

Eigen::Vector2d project(const CameraOptics& optics, const Eigen::Vector2d& plate_mm, double s_mm) {
    const CameraGeometry& camera = optics.nominal;
    if (optics.straight) return fidservo::project(camera, plate_mm, s_mm);
    const Eigen::Vector3d seen =
        optics.turn * Eigen::Vector3d(plate_mm.x() - s_mm, plate_mm.y(), camera.distance_mm);
    const Eigen::Vector2d ideal = seen.head<2>() / seen.z();
    const double radial = 1.0 + optics.distortion * ideal.squaredNorm();
    return camera.principal_point_px + camera.focal_px * optics.pixel_scale * radial * ideal;
}

Eigen::Vector2d back_project(const CameraOptics& optics, const Eigen::Vector2d& image_px, double s_mm) {
    const CameraGeometry& camera = optics.nominal;
    if (optics.straight) return fidservo::back_project(camera, image_px, s_mm);
    Eigen::Vector2d ideal = (image_px - camera.principal_point_px) / (camera.focal_px * optics.pixel_scale);
    const double distorted = ideal.norm();
    if (optics.distortion != 0.0 && distorted > 0.0)
        ideal *= undistorted(distorted, optics.distortion) / distorted;
    const Eigen::Vector3d ray = optics.turn.transpose() * Eigen::Vector3d(ideal.x(), ideal.y(), 1.0);
    return camera.distance_mm / ray.z() * ray.head<2>() + Eigen::Vector2d(s_mm, 0.0);
}

double row_delay_s(const CameraGeometry& camera, const CameraDeviation& deviation, double v_px) {
    if (deviation.readout_s == 0.0 || camera.height_px < 2) return 0.0;
    return deviation.readout_s * (v_px / (camera.height_px - 1) - 0.5);
}

}  // namespace fidservo::plant
