// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Corners with noise of a hand-held flat target in front of a camera with either lens model.
#include "calib/camera/camera_calibration.h"
#include "calib/camera/target_view.h"
#include "core/camera/camera_geometry.h"
#include "core/random.h"
#include "tests/calib/synthetic_target.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace fidservo::calib {

inline double between(NoiseStream& random, double low, double high) {
    return low + (high - low) * random.uniform();
}

/// How the target was held.
struct Handling {
    int views = 16;
    double most_tilt_rad = 0.7;  ///< of the target's normal from the line of sight
    double least_tilt_rad = 0.2;
    double most_off_axis_rad = 0.6;  ///< of the target's middle from the optical axis
    double noise_px = 0.1;
};

/// Image of a point in the camera's frame; NaN where a plumb_bob lens sees nothing: behind it, or where its
/// distortion is no longer one-to-one.
inline Eigen::Vector2d picture_px(const CameraGeometry& lens, const Eigen::Vector3d& seen) {
    const Eigen::Vector2d none = Eigen::Vector2d::Constant(std::nan(""));
    if (lens.distortion.model == LensModel::plumb_bob) {
        if (seen.z() <= 0.0) return none;
        for (int k = 1; k <= 8; ++k)
            if (distortion_slope(lens.distortion, k / 8.0 * seen.head<2>() / seen.z()).determinant() <= 0.05)
                return none;
    }
    const Eigen::Vector2d pictured = picture_of(lens.distortion, seen);
    return lens.principal_point_px +
           lens.focal_px * Eigen::Vector2d(pictured.x(), lens.focal_ratio * pictured.y());
}

/// Tags wholly in the image, their corners with independent errors of known
/// size.
inline TargetView view_at(const CameraGeometry& lens, const std::vector<PlateTag>& tags,
                          const Eigen::Matrix3d& turn, const Eigen::Vector3d& shift_mm, double noise_px,
                          NoiseStream& noise) {
    return view_of_tags(
        "", lens, tags,
        [&](const Eigen::Vector2d& at_mm) { return picture_px(lens, turn.leftCols<2>() * at_mm + shift_mm); },
        Scatter::every_coordinate, noise_px, noise);
}

/// Views with the target's middle off the axis to all sides, its normal tilted
/// from the line of sight, at distances that fill some of the image.
inline std::vector<TargetView> hand_held_views(const CameraGeometry& lens, const std::vector<PlateTag>& tags,
                                               const Handling& handling, NoiseStream& random) {
    Eigen::Vector2d low = tags.front().centre_mm, high = low;
    for (const PlateTag& tag : tags) {
        low = low.cwiseMin(tag.centre_mm);
        high = high.cwiseMax(tag.centre_mm);
    }
    const Eigen::Vector3d middle(0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), 0.0);
    const double size_mm = (high - low).norm();
    std::vector<TargetView> views;
    for (int trial = 0; trial < 50 * handling.views && std::ssize(views) < handling.views; ++trial) {
        const double around_rad = between(random, -std::numbers::pi, std::numbers::pi);
        const double off_rad = handling.most_off_axis_rad * std::sqrt(random.uniform());
        const Eigen::Vector3d sight(std::sin(off_rad) * std::cos(around_rad),
                                    std::sin(off_rad) * std::sin(around_rad), std::cos(off_rad));
        const double tilt_rad = between(random, handling.least_tilt_rad, handling.most_tilt_rad);
        const double towards_rad = between(random, -std::numbers::pi, std::numbers::pi);
        const Eigen::Vector3d axis(std::cos(towards_rad), std::sin(towards_rad), 0.0);
        const Eigen::Matrix3d turn = (Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), sight) *
                                      Eigen::AngleAxisd(tilt_rad, axis) *
                                      Eigen::AngleAxisd(between(random, -3.1, 3.1), Eigen::Vector3d::UnitZ()))
                                         .toRotationMatrix();
        // Half the angle of view across the image's shorter side, which determines how near the target has to
        // be to fill it.
        const double field = 0.5 * std::min(lens.width_px, lens.height_px) / lens.focal_px;
        const double distance_mm = 0.5 * size_mm / std::tan(std::min(field, 1.0)) * between(random, 0.7, 1.6);
        TargetView view =
            view_at(lens, tags, turn, distance_mm * sight - turn * middle, handling.noise_px, random);
        view.name = "view " + std::to_string(views.size() + 1);
        if (std::ssize(view.tags) * 3 >= std::ssize(tags)) views.push_back(std::move(view));
    }
    return views;
}

inline CameraCalibrationOptions options_for_lens(const CameraGeometry& lens, LensModel model) {
    CameraCalibrationOptions options;
    options.width_px = lens.width_px;
    options.height_px = lens.height_px;
    options.model = model;
    return options;
}

}  // namespace fidservo::calib
