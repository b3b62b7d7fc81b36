// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a tag of a known code should look like, held against the image.
#include "core/tag_families.h"

#include <array>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// What a tag's cells say about a pattern that is thought to be there.
struct PatternMatch {
    /// How much of what is seen the pattern explains, both fitted to nine points of every cell; x and y allow
    /// for uneven light:
    ///
    ///     1 - |grey - black - (white - black) pattern - gx x - gy y|^2 / |grey - level - gx' x - gy' y|^2
    ///
    /// 1 for a perfect print, about 0 for bare paper. A chance agreement of texture with the code book has
    /// edges inside the cells and levels in between, and stays far below a tag. 0 if more than a quarter of
    /// the tag lies outside the image, or if black is brighter than white.
    double explained = 0.0;
    double contrast = 0.0;  ///< white - black, grey levels
    /// Of the code, and of what is alike on every tag: those on the other side of the middle between black
    /// and white.
    int wrong_code_bits = TagPattern::most_cells * TagPattern::most_cells;
    int wrong_fixed_cells = TagPattern::most_cells * TagPattern::most_cells;
    double margin = 0.0;  ///< mean distance of the code's cells from that middle, grey levels
};

/// Cells outside the image count as wrong.
/// @param corners_px  in detection order, pixel centres at integers
PatternMatch match_pattern(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                           const TagPattern& pattern);

/// PatternMatch::explained alone.
double explained_contrast(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                          const TagPattern& pattern);

/// The same over the code's cells alone: where a square that is dark all around has something else in it, its
/// border says nothing about the code.
double explained_code(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                      const TagPattern& pattern);

/// The least that is taken for a tag.
struct LeastExplained {
    double of_tag;   ///< explained_contrast()
    double of_code;  ///< explained_code()
};

/// Where the levels of n cells are chance, the share R^2 that one given pattern explains beside level, x and
/// y has the distribution Beta(1/2, (n - 4)/2), and a book of N codes tries 4 N patterns: small codes in
/// large books agree with chance most easily. Both levels are those at which
///
///     4 N P(R^2 > level)
///
/// is what it is for tag36h11 at 0.4, with the n cells of a tag with a border of one cell, and of its code
/// (wider borders add nothing: their cells are alike). A tag36h11 is judged as a whole alone: real ones reach
/// 0.43 at 1.5 px a cell and 0.95 on the machine; texture that reads as a code, 0.31 at most in 240 images of
/// noise.
LeastExplained least_explained(const TagFamily& family);

/// Whether a pattern explains what is seen by both levels; a level of the code of 0 asks for nothing.
bool is_convincing(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                   const TagPattern& pattern, const LeastExplained& least);

}  // namespace fidservo::vision
