// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The parts of an image that have enough contrast for a tag.
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// Boxes that hold all neighbourhoods (3 x 3 tiles of 4 x 4 px) whose grey levels span `min_contrast` or
/// more, each with room for a tag's quiet zone around it, disjoint, from top to bottom; libapriltag, with the
/// same tiles and threshold, sees no edge anywhere else. Box corners lie on the tiles' grid. Empty for a
/// blank image.
/// @param image  CV_8UC1
std::vector<cv::Rect> contrast_regions(const cv::Mat& image, int min_contrast);

/// The one box that holds all of these neighbourhoods, with the same room around it; empty for a blank image.
cv::Rect contrast_box(const cv::Mat& image, int min_contrast);

}  // namespace fidservo::vision
