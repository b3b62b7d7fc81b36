// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Pictures of tags of any family, whose cells come from the libraries that define them, not from the program.
#include "core/detection.h"
#include "vision/tags/tag_book.h"

#include <array>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::testing {

/// A tag with its print and its place in the image.
struct DrawnTag {
    vision::TagReading reading;
    int id;
    std::array<Eigen::Vector2d, 4> corners_px;  ///< of the outline, in detection order
    /// Black squares touch the corners, as on an AprilGrid; for borders of two cells.
    bool corner_squares = false;
};

/// Cells of all that is printed, 255 is white, without the paper around.
cv::Mat1b cells_of(const TagPrint& print, int id);

/// Tags on paper (on black, where they are inverted), at 36 samples a pixel, blurred by `blur_px`, with noise
/// of 1 grey level.
cv::Mat1b draw(const std::vector<DrawnTag>& tags, cv::Size size_px, double blur_px, std::mt19937_64& random);

/// Any of `families` with an id at random, upright in the reading's own frame.
TagPrint random_print(std::mt19937_64& random);

/// Corners of a tag about a place, its outline `side_px` long, at any angle, with some perspective; mirrored
/// where the reading is.
std::array<Eigen::Vector2d, 4> random_corners(const Eigen::Vector2d& centre_px, double side_px, bool mirrored,
                                              std::mt19937_64& random);

inline double between(double low, double high, std::mt19937_64& random) {
    return std::uniform_real_distribution<double>(low, high)(random);
}
inline int one_of(int count, std::mt19937_64& random) {
    return std::uniform_int_distribution<int>(0, count - 1)(random);
}

/// Sides in cells of the outline and of all that is printed, from what the libraries say.
struct DrawnSize {
    int outline, all;
};
DrawnSize size_of(const TagPrint& print);

}  // namespace fidservo::testing
