#pragma once
// What a tag of a known code should look like, held against the image.
#include <array>
#include <bitset>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// Black border and code of a tag36h11: 8 x 8 cells, row by row from the tag's upper left, true is white.
using TagPattern = std::bitset<64>;

/// The pattern of a code of the book. Demands 0 <= tag_id < 587.
TagPattern tag_pattern(int tag_id);

/// How much of what is seen inside a tag's outline its pattern explains:
///
///     1 - |grey - black - (white - black) pattern - gx x - gy y|^2 / |grey - level - gx' x - gy' y|^2
///
/// both fitted to nine points of every cell; x and y allow for uneven light. 1 for a perfect print, about 0
/// for bare paper. A chance agreement of texture with the code book has edges inside the cells and levels in
/// between, and stays far below a tag. 0 if more than a quarter of the tag lies outside the image, or if
/// black is brighter than white.
/// @param corners_px  in detection order, pixel centres at integers
double explained_contrast(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                          const TagPattern& pattern);

}  // namespace fidservo::vision
