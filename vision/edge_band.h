#pragma once
// The pixels along the edges of a tag's code: all that tells where the tag is.
#include "vision/band_kernel.h"
#include "vision/tag_pattern.h"
#include "vision/tag_picture.h"

#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// Neighbouring pixels of one node that are judged together.
struct BandBlock {
    std::size_t begin, end;  ///< the kernel's: with pixels that fill up
    std::size_t pixels;      ///< without them
};

/// Structure of arrays. Each node's pixels are filled up to a multiple of lane_count with copies of the last
/// one, of weight 0.
struct EdgeBand {
    std::vector<float> qx, qy;  ///< tag_picture.h
    std::vector<float> grey;
    std::vector<float> weight;  ///< square root of
    std::vector<kernel::Node> nodes;
    std::vector<BandBlock> blocks;
    std::size_t pixels = 0;  ///< without those that fill up

    /// Gives all pixels of a block a weight.
    void weigh(const BandBlock& block, float root_of_weight);
};

/// How far from the edges to look, px, for the lines x = const and y = const.
struct BandReach {
    double x_px, y_px;
};

/// Fills a band with all pixels within reach of the pattern's edges where `picture` sees them, at most half a
/// cell away.
/// @param every  only every so-manieth crossing: a quicker look
void select_band(const cv::Mat& image, const TagPicture& picture, const TagPattern& pattern,
                 const BandReach& reach, int every, EdgeBand& band);

}  // namespace fidservo::vision
