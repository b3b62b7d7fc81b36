// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/camera/camera_slopes.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace fidservo {
namespace {

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

/// Whether the lens model still has a ray for an image point as far from the principal point as the nearest
/// side of the image is.
bool reaches_a_side(const CameraGeometry& camera) {
    const Eigen::Vector2d low = pictured_at(camera, {-0.5, -0.5});
    const Eigen::Vector2d high = pictured_at(camera, {camera.width_px - 0.5, camera.height_px - 0.5});
    const double nearest = std::min(low.cwiseAbs().minCoeff(), high.cwiseAbs().minCoeff());
    return ray_of(camera.distortion, {nearest, 0.0}).allFinite();
}

}  // namespace

Eigen::Vector3d stage_axis(const CameraGeometry& camera) {
    return Eigen::Vector3d(1.0, camera.axis_rad.x(), camera.axis_rad.y()).normalized();
}

Eigen::Vector2d pictured_at(const CameraGeometry& camera, const Eigen::Vector2d& image_px) {
    Eigen::Vector2d pictured = (image_px - camera.principal_point_px) / camera.focal_px;
    pictured.y() /= camera.focal_ratio;
    return pictured;
}

Eigen::Vector2d ideal_point(const CameraGeometry& camera, const Eigen::Vector2d& image_px) {
    return undistort(camera.distortion, pictured_at(camera, image_px));
}

Eigen::Matrix2d ideal_by_image(const CameraGeometry& camera, const Eigen::Vector2d& image_px) {
    return slope_at(camera, ideal_point(camera, image_px));
}

Eigen::Matrix2d plate_by_image(const CameraGeometry& camera, const Eigen::Vector2d& image_px, double s_mm) {
    if (looks_straight(camera)) return mm_per_px(camera) * Eigen::Matrix2d::Identity();
    const LensDistortion& lens = camera.distortion;
    const Eigen::Vector3d seen = ray_of(lens, pictured_at(camera, image_px));
    const Eigen::Matrix3d plate_from_camera = camera_from_plate(camera).transpose();
    const Eigen::Vector3d ray = plate_from_camera * seen;
    const double height_mm = camera.distance_mm - s_mm * stage_axis(camera).z();
    const auto plate_by = [&](const Eigen::Matrix<double, 3, 2>& ray_by) -> Eigen::Matrix2d {
        return height_mm / ray.z() * (ray_by.topRows<2>() - ray.head<2>() / ray.z() * ray_by.row(2));
    };
    if (lens.model == LensModel::plumb_bob)
        return plate_by(plate_from_camera.leftCols<2>()) * slope_at(camera, seen.head<2>());
    const Eigen::DiagonalMatrix<double, 2> pictured_by_image(1.0 / camera.focal_px,
                                                             1.0 / (camera.focal_px * camera.focal_ratio));
    return plate_by(plate_from_camera * ray_slope(lens, seen)) * pictured_by_image;
}

double mm_per_px_at(const CameraGeometry& camera, const Eigen::Vector2d& image_px, double s_mm) {
    if (looks_straight(camera)) return mm_per_px(camera);
    return std::sqrt(std::abs(plate_by_image(camera, image_px, s_mm).determinant()));
}

bool lens_is_one_to_one(const CameraGeometry& camera) {
    if (camera.distortion.is_none()) return true;
    if (camera.distortion.model == LensModel::equidistant) return reaches_a_side(camera);
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
