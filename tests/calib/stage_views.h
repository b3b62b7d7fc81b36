// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Synthetic views of a row of tags by a camera of known mount, with noise of known covariance.
#include "calib/camera/pictured_corners.h"
#include "calib/stage/stage_map.h"
#include "core/random.h"
#include "vision/tags/tag_choice.h"

#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

namespace fidservo::calib {

inline Plate row_of_tags() {
    Plate plate;
    for (int i = 0; i <= 100; ++i) plate.tags.push_back({i, {2.0 * i, 0.0}, 1.2});
    return plate;
}

inline CameraGeometry straight_camera() {
    return {1280, 960, 5000.0, {639.5, 479.5}, 20.0};
}

/// Covariance of a tag's corners, which share its edges: a common part and a part for each corner, px^2.
inline vision::CornerCovariance corner_covariance(double std_px) {
    vision::CornerCovariance covariance = vision::CornerCovariance::Identity();
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j)
            if (i % 2 == j % 2) covariance(i, j) += 0.5;
    return std_px * std_px * covariance;
}

/// The tags wholly in the image of a camera at s.
/// @param y_mm  plate y of the stage's axis at s = 0
inline StageView synthetic_view(const CameraGeometry& camera, double y_mm, double s_mm, double std_px,
                                NoiseStream& noise) {
    StageView view;
    const vision::CornerCovariance covariance = corner_covariance(std_px);
    const vision::CornerCovariance root = covariance.llt().matrixL();
    for (const PlateTag& tag : row_of_tags().tags) {
        // Far outside the image the formula of a barrel lens maps back into it.
        if (std::abs(tag.centre_mm.x() - s_mm) > 6.0) continue;
        PlateTag shifted = tag;
        shifted.centre_mm.y() -= y_mm;
        const auto corners = pictured_corners(camera, shifted, s_mm);
        bool inside = true;
        for (const Eigen::Vector2d& corner : corners)
            inside = inside && corner.x() > 20.0 && corner.x() < camera.width_px - 20.0 &&
                     corner.y() > 20.0 && corner.y() < camera.height_px - 20.0;
        if (!inside) continue;
        Eigen::Matrix<double, 8, 1> white;
        for (int i = 0; i < 8; ++i) white(i) = noise.normal();
        const Eigen::Matrix<double, 8, 1> error = root * white;
        SeenTag seen{tag, corners, covariance};
        for (std::size_t k = 0; k < 4; ++k) seen.corners_px[k] += error.segment<2>(static_cast<int>(2 * k));
        view.push_back(seen);
    }
    return view;
}

/// Stands over a distance, irregular with respect to the tags' pitch, so that tags appear all over the image.
inline std::vector<double> spread_places(int count, double from_mm, double to_mm) {
    std::vector<double> places;
    for (int i = 0; i < count; ++i) {
        const double golden = std::fmod(0.618034 * i, 1.0);
        places.push_back(from_mm + (to_mm - from_mm) * i / (count - 1) + 2.0 * (golden - 0.5));
    }
    return places;
}

}  // namespace fidservo::calib
