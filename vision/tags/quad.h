// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The outline of a tag as a projective map of a square.
#include "core/detection.h"

#include <array>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// The homography H that maps tag_corners to the four image points: (u, v, 1) ~ H (x, y, 1), H(2,2) = 1. It
/// is not finite where three points are on a line.
Eigen::Matrix3d square_to_image(const std::array<Eigen::Vector2d, 4>& corners_px);

inline Eigen::Vector2d map_point(const Eigen::Matrix3d& homography, const Eigen::Vector2d& point) {
    const Eigen::Vector3d mapped = homography * Eigen::Vector3d(point.x(), point.y(), 1.0);
    return mapped.head<2>() / mapped.z();
}

/// The intersection of the diagonals: the image of the tag's centre.
Eigen::Vector2d centre_of(const std::array<Eigen::Vector2d, 4>& corners_px);

/// Whether the picture is mirrored: the corners then go round the other way.
bool is_mirrored(const std::array<Eigen::Vector2d, 4>& corners_px);

/// The corners of a tag that was read in a mirrored picture, reordered as on the print.
std::array<Eigen::Vector2d, 4> mirrored(const std::array<Eigen::Vector2d, 4>& corners_px);

double longest_side_px(const std::array<Eigen::Vector2d, 4>& corners_px);

/// Whether two detections are of one printed tag: nearer to each other than two printed tags can be.
bool same_place(const std::array<Eigen::Vector2d, 4>& a_px, const std::array<Eigen::Vector2d, 4>& b_px);

/// Whether bilinear interpolation has its four neighbours at a point.
inline bool can_sample(const cv::Mat& image, const Eigen::Vector2d& at_px) {
    return at_px.x() >= 0 && at_px.y() >= 0 && at_px.x() < image.cols - 1 && at_px.y() < image.rows - 1;
}

/// Grey level of a CV_8UC1 image between pixel centres, bilinear. Demands can_sample().
inline double sample(const cv::Mat& image, const Eigen::Vector2d& at_px) {
    const int column = static_cast<int>(at_px.x());
    const int row = static_cast<int>(at_px.y());
    const double fx = at_px.x() - column;
    const double fy = at_px.y() - row;
    const auto* upper = image.ptr<unsigned char>(row) + column;
    const auto* lower = image.ptr<unsigned char>(row + 1) + column;
    return (1 - fy) * ((1 - fx) * upper[0] + fx * upper[1]) + fy * ((1 - fx) * lower[0] + fx * lower[1]);
}

}  // namespace fidservo::vision
