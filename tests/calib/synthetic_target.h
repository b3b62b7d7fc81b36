// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Tags at the places where core's projection puts them, with noise of known covariance, so that the right
// result of a calibration is known.
#include "calib/camera/target_view.h"
#include "core/camera/camera_geometry.h"
#include "core/random.h"
#include "vision/tags/quad.h"
#include "vision/tags/tag_choice.h"

#include <string>
#include <vector>

#include <Eigen/Core>

namespace fidservo::calib {

/// A grid of tags about the origin.
inline std::vector<PlateTag> tag_grid(int columns, int rows, double side_mm, double pitch_mm) {
    std::vector<PlateTag> tags;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            tags.push_back({.id = row * columns + column,
                            .centre_mm = {pitch_mm * (column - 0.5 * (columns - 1)),
                                          pitch_mm * (row - 0.5 * (rows - 1))},
                            .side_mm = side_mm});
    return tags;
}

/// How a tag's corners scatter: as a tag refined with a calibrated camera (place, rotation and scale, four
/// directions), or each coordinate on its own.
enum class Scatter { rigid, every_coordinate };

/// One tag with its noise. Rigid: a shift of std_px along u and v, and rotation and scale that move the
/// corners by as much.
inline vision::RefinedTag scattered(TagDetection tag, Scatter scatter, double std_px, NoiseStream& noise) {
    Eigen::Matrix<double, 8, 8> directions = Eigen::Matrix<double, 8, 8>::Identity();
    if (scatter == Scatter::rigid) {
        directions.setZero();
        const Eigen::Vector2d centre = vision::centre_of(tag.corners_px);
        for (int k = 0; k < 4; ++k) {
            const Eigen::Vector2d arm = (tag.corners_px[static_cast<std::size_t>(k)] - centre).normalized();
            directions.block<2, 2>(2 * k, 0).setIdentity();
            directions.block<2, 1>(2 * k, 2) = Eigen::Vector2d(-arm.y(), arm.x());
            directions.block<2, 1>(2 * k, 3) = arm;
        }
    }
    directions *= std_px;
    Eigen::Matrix<double, 8, 1> normals;
    for (int k = 0; k < 8; ++k) normals(k) = noise.normal();
    const Eigen::Matrix<double, 8, 1> error = directions * normals;
    for (int k = 0; k < 4; ++k) tag.corners_px[static_cast<std::size_t>(k)] += error.segment<2>(2 * k);
    return vision::tag_of_corners(tag, directions * directions.transpose());
}

/// The tags wholly in a camera's image, their corners with noise.
/// @param picture  maps a place on the target, mm, to the image, px
template <class Picture>
TargetView view_of_tags(std::string name, const CameraGeometry& camera, const std::vector<PlateTag>& tags,
                        Picture picture, Scatter scatter, double std_px, NoiseStream& noise) {
    TargetView view{.name = std::move(name), .tags = {}};
    for (const PlateTag& tag : tags) {
        TagDetection seen;
        seen.tag_id = tag.id;
        const auto corners_mm = vision::corners_mm(tag);
        bool inside = true;
        for (std::size_t k = 0; k < 4; ++k) {
            const Eigen::Vector2d at = picture(corners_mm[k]);
            inside = inside && at.minCoeff() > 0.0 && at.x() < camera.width_px - 1 &&
                     at.y() < camera.height_px - 1;
            seen.corners_px[k] = at;
        }
        if (inside) view.tags.push_back({tag, scattered(seen, scatter, std_px, noise)});
    }
    return view;
}

/// What a camera at (s, y) sees of the tags, those wholly in its image.
inline TargetView synthetic_view(const CameraGeometry& camera, const std::vector<PlateTag>& tags, double s_mm,
                                 double y_mm, Scatter scatter, double std_px, NoiseStream& noise) {
    return view_of_tags(
        "s = " + std::to_string(s_mm), camera, tags,
        [&](const Eigen::Vector2d& at_mm) {
            return project(camera, at_mm - Eigen::Vector2d(0.0, y_mm), s_mm);
        },
        scatter, std_px, noise);
}

}  // namespace fidservo::calib
