// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The pixels along the edges of a tag's code: all that tells where the tag is.
#include "vision/tags/band_kernel.h"
#include "vision/tags/tag_pattern.h"
#include "vision/tags/tag_picture.h"

#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// Structure of arrays. Each block's pixels are filled up to a multiple of lane_count.
struct EdgeBand {
    std::vector<float> u, v;            ///< TagPicture::Cubic's U and V
    std::vector<unsigned char> levels;  ///< grey levels as the image has them
    std::vector<float> grey;            ///< and as the kernel takes them
    std::vector<kernel::Node> nodes;
    std::vector<kernel::Block> blocks;
    std::vector<float> weights;  ///< of the blocks, square roots of
    std::size_t pixels = 0;      ///< without those that fill up
};

/// How far from the edges to look, px, for the lines x = const and y = const.
struct BandReach {
    double x_px, y_px;
};

/// Fills a band with all pixels within reach of the pattern's edges where `picture` sees them, at most half a
/// cell away. All weights are 1.
/// @param share  of the edges that are taken, spread over the tag: less than 1 for a quicker look
void select_band(const cv::Mat& image, const TagPicture& picture, const TagPattern& pattern,
                 const BandReach& reach, double share, EdgeBand& band);

}  // namespace fidservo::vision
