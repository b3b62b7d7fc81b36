// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Squares that could be tags, whatever is inside, for messages about images in which no tag was read.
#include <array>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// A convex outline of four straight sides that is darker, or brighter, inside than outside all around.
struct SquareOutline {
    std::array<Eigen::Vector2d, 4> corners_px;
    double side_px;        ///< mean of the four
    double contrast_grey;  ///< grey level outside minus inside, close to the sides
    /// Standard deviation of the profile of its sides: contrast / (steepest slope sqrt(2 pi)).
    double blur_px;
    bool has_pattern;  ///< the grey levels inside vary by a large part of the contrast, as a code's do
};

/// Finds squares of 8 px and more by adaptive thresholds with two neighbourhood sizes, and once more with
/// touching corners separated. Each outline is listed once.
/// @param image  CV_8UC1
std::vector<SquareOutline> square_outlines(const cv::Mat& image);

}  // namespace fidservo::vision
