// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Images in which no tags, or few, were found: what else could be read in them, and what they show.
#include "vision/tags/tag_book.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// A reading that was tried on the images, and found so many tags.
struct TriedReading {
    TagReading reading;
    std::size_t tags;
};

/// Of all images together.
struct ImagesSeen {
    double darkest_grey = 0.0, brightest_grey = 0.0;  ///< all but 1 % of the pixels at either end
    double saturated_share = 0.0;                     ///< of the pixels, at 255
    std::size_t squares = 0;                          ///< with four straight sides (square_outlines.h)
    std::size_t patterned = 0;                        ///< of these that have something in them
    /// Medians: of those that have something in them, of all where none has.
    double side_px = 0.0, contrast_grey = 0.0, blur_px = 0.0;
};

struct OtherReadings {
    std::size_t images = 0;
    std::size_t tags = 0;  ///< found as they were looked for
    /// Those that find the most tags, more than that; several where they find equally many.
    std::vector<TriedReading> better;
    ImagesSeen seen;
};

/// Whether more squares look like tags than tags were found: twice as many or more.
bool looks_unread(const cv::Mat& image, std::size_t tags_found);

/// Looks for all families, with borders of one and two cells, as printed and inverted, as they are and
/// mirrored; whatever seems to be there is then looked for alone, as a user would. Images of more than three
/// million pixels are made smaller. Costs some ten searches of every image: a second for a few of a million.
/// @param images  CV_8UC1
OtherReadings try_other_readings(std::span<const cv::Mat> images, const TagReading& tried);

/// What was seen, and of the causes that were checked those that hold; one line.
std::string text_of(const ImagesSeen& seen, const TagReading& tried);

}  // namespace fidservo::vision
