#include "core/camera_slopes.h"

#include <cmath>

#include <Eigen/LU>

namespace fidservo {
namespace {

/// (x', y') of an image point.
Eigen::Vector2d pictured_at(const CameraGeometry& camera, const Eigen::Vector2d& image_px) {
    Eigen::Vector2d pictured = (image_px - camera.principal_point_px) / camera.focal_px;
    pictured.y() /= camera.focal_ratio;
    return pictured;
}

/// ideal_by_image() of the image point whose ideal point is given.
Eigen::Matrix2d slope_at(const CameraGeometry& camera, const Eigen::Vector2d& ideal) {
    Eigen::Matrix2d slope = distortion_slope(camera.distortion, ideal).inverse() / camera.focal_px;
    slope.col(1) /= camera.focal_ratio;
    return slope;
}

/// Whether undistort() finds the ideal point of an image point, and the lens does not fold on the way there.
bool pictures_once(const CameraGeometry& camera, const Eigen::Vector2d& image_px) {
    constexpr int steps = 32;
    const Eigen::Vector2d pictured = pictured_at(camera, image_px);
    const Eigen::Vector2d ideal = undistort(camera.distortion, pictured);
    const double error_px = (distort(camera.distortion, ideal) - pictured).norm() * camera.focal_px;
    if (!(error_px < 1e-6)) return false;
    for (int k = 1; k <= steps; ++k) {
        const double share = static_cast<double>(k) / steps;
        if (!(distortion_slope(camera.distortion, share * ideal).determinant() > 0.0)) return false;
    }
    return true;
}

}  // namespace

Eigen::Vector3d stage_axis(const CameraGeometry& camera) {
    return Eigen::Vector3d(1.0, camera.axis_rad.x(), camera.axis_rad.y()).normalized();
}

Eigen::Vector2d ideal_point(const CameraGeometry& camera, const Eigen::Vector2d& image_px) {
    return undistort(camera.distortion, pictured_at(camera, image_px));
}

Eigen::Matrix2d distortion_slope(const LensDistortion& lens, const Eigen::Vector2d& ideal) {
    const double x = ideal.x(), y = ideal.y(), r2 = ideal.squaredNorm();
    const double radial = 1.0 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3));
    const double slope = 2.0 * (lens.k1 + r2 * (2.0 * lens.k2 + r2 * 3.0 * lens.k3));
    const double mixed = slope * x * y + 2.0 * lens.p1 * x + 2.0 * lens.p2 * y;
    Eigen::Matrix2d jacobian;
    jacobian << radial + slope * x * x + 2.0 * lens.p1 * y + 6.0 * lens.p2 * x, mixed, mixed,
        radial + slope * y * y + 6.0 * lens.p1 * y + 2.0 * lens.p2 * x;
    return jacobian;
}

Eigen::Matrix2d ideal_by_image(const CameraGeometry& camera, const Eigen::Vector2d& image_px) {
    return slope_at(camera, ideal_point(camera, image_px));
}

Eigen::Matrix2d plate_by_image(const CameraGeometry& camera, const Eigen::Vector2d& image_px, double s_mm) {
    if (looks_straight(camera)) return mm_per_px(camera) * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d ideal = ideal_point(camera, image_px);
    const Eigen::Matrix3d plate_from_camera = camera_from_plate(camera).transpose();
    const Eigen::Vector3d ray = plate_from_camera * Eigen::Vector3d(ideal.x(), ideal.y(), 1.0);
    const Eigen::Matrix<double, 3, 2> ray_by_ideal = plate_from_camera.leftCols<2>();
    const double height_mm = camera.distance_mm - s_mm * stage_axis(camera).z();
    const Eigen::Matrix2d plate_by_ideal =
        height_mm / ray.z() * (ray_by_ideal.topRows<2>() - ray.head<2>() / ray.z() * ray_by_ideal.row(2));
    return plate_by_ideal * slope_at(camera, ideal);
}

double mm_per_px_at(const CameraGeometry& camera, const Eigen::Vector2d& image_px, double s_mm) {
    if (looks_straight(camera)) return mm_per_px(camera);
    return std::sqrt(std::abs(plate_by_image(camera, image_px, s_mm).determinant()));
}

bool lens_is_one_to_one(const CameraGeometry& camera) {
    if (camera.distortion.is_none()) return true;
    constexpr int steps = 16;
    for (int k = 0; k <= steps; ++k) {
        const double u = -0.5 + camera.width_px * static_cast<double>(k) / steps;
        const double v = -0.5 + camera.height_px * static_cast<double>(k) / steps;
        if (!pictures_once(camera, {u, -0.5}) || !pictures_once(camera, {u, camera.height_px - 0.5}) ||
            !pictures_once(camera, {-0.5, v}) || !pictures_once(camera, {camera.width_px - 0.5, v}))
            return false;
    }
    return true;
}

}  // namespace fidservo
