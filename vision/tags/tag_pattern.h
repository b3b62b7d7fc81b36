// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Comparison of the image with the pattern of a tag of a known code.
#include "core/tag_families.h"

#include <array>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// How well an image matches the pattern of a tag.
struct PatternMatch {
    /// The fraction of variance that the pattern explains, from fits to nine points in every cell; the terms
    /// in x and y allow for uneven light:
    ///
    ///     1 - |grey - black - (white - black) pattern - gx x - gy y|^2 / |grey - level - gx' x - gy' y|^2
    ///
    /// 1 for a perfect print, about 0 for bare paper. Texture that agrees with a code by chance has edges
    /// inside the cells and intermediate levels, and reaches far less than a tag. 0 if more than a quarter of
    /// the tag lies outside the image, or if black is brighter than white.
    double explained = 0.0;
    double contrast = 0.0;  ///< white - black, grey levels
    /// Numbers of wrong code bits, and of wrong cells among those that are the same on every tag: cells on
    /// the wrong side of the mid level between black and white.
    int wrong_code_bits = TagPattern::most_cells * TagPattern::most_cells;
    int wrong_fixed_cells = TagPattern::most_cells * TagPattern::most_cells;
    double margin = 0.0;  ///< mean distance of the code's cells from the mid level, grey levels
};

/// Matches a pattern at these corners. Cells outside the image count as wrong.
/// @param corners_px  in the order of detections, pixel centres at integers
PatternMatch match_pattern(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                           const TagPattern& pattern);

/// PatternMatch::explained alone.
double explained_contrast(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                          const TagPattern& pattern);

/// explained_contrast() over the cells of the code only, since a dark border around another pattern is no
/// evidence for the code.
double explained_code(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                      const TagPattern& pattern);

/// The least fractions of variance explained at which a pattern counts as a tag.
struct LeastExplained {
    double of_tag;   ///< explained_contrast()
    double of_code;  ///< explained_code()
};

/// The least fractions of a family. If the grey levels of n cells are random, the fraction R^2 that a given
/// pattern explains in addition to level, x and y has the distribution Beta(1/2, (n - 4)/2). A family of N
/// codes tries 4 N patterns, so that small codes in large families match by chance most easily. Both
/// fractions are those at which
///
///     4 N P(R^2 > level)
///
/// has the same value as for tag36h11 at 0.4. For of_tag, n is the number of cells of a tag with a border of
/// one cell (wider borders add no information, since their cells are alike), for of_code that of the code.
/// tag36h11 is judged by explained_contrast() only: real tags reach 0.43 at 1.5 px a cell and 0.95 on the
/// machine; textures that were read as a code in 240 images of noise reached at most 0.31.
LeastExplained least_explained(const TagFamily& family);

/// Whether a pattern reaches both levels; a level of_code of 0 is not tested.
bool is_convincing(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                   const TagPattern& pattern, const LeastExplained& least);

}  // namespace fidservo::vision
