// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Help for images in which no or few tags were found: other families, borders, inversions or mirrorings that
// find tags in them, and statistics of the images.
#include "vision/tags/tag_book.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// A reading (family, border, inversion, mirroring) that was tried on the images, and the number of tags it
/// found.
struct TriedReading {
    TagReading reading;
    std::size_t tags;
};

/// Statistics of all images together.
struct ImagesSeen {
    double darkest_grey = 0.0, brightest_grey = 0.0;  ///< 1 % and 99 % quantiles of the pixels
    double saturated_share = 0.0;                     ///< fraction of the pixels at 255
    std::size_t squares = 0;    ///< outlines with four straight sides (square_outlines.h)
    std::size_t patterned = 0;  ///< squares that have a pattern inside
    /// Medians over the squares with a pattern, or over all squares if none has one.
    double side_px = 0.0, contrast_grey = 0.0, blur_px = 0.0;
};

struct OtherReadings {
    std::size_t images = 0;
    std::size_t tags = 0;  ///< number found with the reading that was asked for
    /// The readings that find more tags than `tags`: the best one, or several that find equally many. Among
    /// readings that decode the same squares, the one whose matches are least likely by chance is taken.
    std::vector<TriedReading> better;
    ImagesSeen seen;
};

/// Whether the image has at least twice as many squares that look like tags as tags were found.
bool looks_unread(const cv::Mat& image, std::size_t tags_found);

/// Tries all families, with borders of one and two cells, as printed and inverted, upright and mirrored. Each
/// reading that seems to find tags is then searched for alone, as a user would do it. Images of more than
/// three million pixels are reduced. Takes about ten times as long as one search: a second for a few images
/// of a million pixels.
/// @param images  CV_8UC1
/// @param tags  the number of tags that a thorough search for `tried` has found in them, if it is known
OtherReadings try_other_readings(std::span<const cv::Mat> images, const TagReading& tried,
                                 std::optional<std::size_t> tags = {});

/// The images' statistics, and those of the known causes of missing tags that apply, in one line.
std::string text_of(const ImagesSeen& seen, const TagReading& tried);

}  // namespace fidservo::vision
