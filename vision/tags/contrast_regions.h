// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The parts of an image that have enough contrast for a tag.
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// Disjoint boxes, from top to bottom, that contain all neighbourhoods (3 x 3 tiles of 4 x 4 px) whose grey
/// levels span `min_contrast` or more, with a margin for a tag's quiet zone. libapriltag, with the same tiles
/// and threshold, finds no edges outside of them. Box corners lie on the tiles' grid. Empty for a blank
/// image.
/// @param image  CV_8UC1
std::vector<cv::Rect> contrast_regions(const cv::Mat& image, int min_contrast);

/// The bounding box of all these neighbourhoods, with the same margin; empty for a blank image.
cv::Rect contrast_box(const cv::Mat& image, int min_contrast);

}  // namespace fidservo::vision
