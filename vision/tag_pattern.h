#pragma once
// What a tag of a known code should look like, held against the image.
#include <array>
#include <bitset>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// Black border and code of a tag36h11, row by row from the tag's upper left, true is white.
struct TagPattern {
    int cells = 8;  ///< a side: six of the code and the border at both ends
    std::bitset<100> white;
    bool operator[](std::size_t cell) const { return white[cell]; }
    /// An AprilGrid's tags have black squares between them that touch their corners.
    bool has_corner_squares() const { return cells == 10; }
};

/// The pattern of a code of the book. Demands 0 <= tag_id < 587.
/// @param border_cells  width of the black border: 1, or 2 on a kalibr AprilGrid
TagPattern tag_pattern(int tag_id, int border_cells = 1);

/// What the cells inside a tag's outline say about a pattern that is thought to be there.
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
    double contrast = 0.0;        ///< white - black, grey levels
    int wrong_code_bits = 36;     ///< of the 36: on the other side of the middle between black and white
    int wrong_border_cells = 28;  ///< of the 28 (64 where the border is two cells wide) that are always black
    double margin = 0.0;          ///< mean distance of the code's cells from that middle, grey levels
};

/// Cells outside the image count as wrong.
/// @param corners_px  in detection order, pixel centres at integers
PatternMatch match_pattern(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                           const TagPattern& pattern);

/// PatternMatch::explained alone.
double explained_contrast(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px,
                          const TagPattern& pattern);

}  // namespace fidservo::vision
