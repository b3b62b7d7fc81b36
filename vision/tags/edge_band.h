// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The pixels along the edges of a tag's code, which carry all information on its place.
#include "vision/tags/band_kernel.h"
#include "vision/tags/tag_pattern.h"
#include "vision/tags/tag_picture.h"

#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// The band as a structure of arrays. Each block's pixels are padded to a multiple of lane_count.
struct EdgeBand {
    std::vector<float> u, v;            ///< coordinates U and V of TagPicture::Cubic
    std::vector<unsigned char> levels;  ///< grey levels as in the image
    std::vector<float> grey;            ///< grey levels in the kernel's type
    std::vector<kernel::Node> nodes;
    std::vector<kernel::Block> blocks;
    std::vector<float> weights;  ///< square roots of the blocks' weights
    std::size_t pixels = 0;      ///< number of pixels without the padding
};

/// How far from the edges pixels are taken, px: for the lines x = const and for y = const.
struct BandReach {
    double x_px, y_px;
};

/// Fills a band with all pixels within reach of the pattern's edges as mapped by `picture`, at most half a
/// cell away. All weights are 1.
/// @param share  fraction of the edges that are taken, spread over the tag; less than 1 for speed
void select_band(const cv::Mat& image, const TagPicture& picture, const TagPattern& pattern,
                 const BandReach& reach, double share, EdgeBand& band);

}  // namespace fidservo::vision
