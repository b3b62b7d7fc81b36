// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Squares that could be tags, whatever is in them: for what to say where no tag was read.
#include <array>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// A convex outline of four straight sides that is darker, or brighter, inside than outside all around.
struct SquareOutline {
    std::array<Eigen::Vector2d, 4> corners_px;
    double side_px;        ///< mean of the four
    double contrast_grey;  ///< grey levels outside less those inside, close to the sides
    double
        blur_px;  ///< standard deviation of the profile of its sides: contrast / (steepest slope sqrt(2 pi))
    bool has_pattern;  ///< what is inside varies by a good part of the contrast, as a code does
};

/// By adaptive thresholds over neighbourhoods of two sizes, once more with corners that touch torn apart.
/// Sides are 8 px or longer. Each outline once.
/// @param image  CV_8UC1
std::vector<SquareOutline> square_outlines(const cv::Mat& image);

}  // namespace fidservo::vision
