// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A tag whose place is roughly known, found again without a search of the image.
#include "core/detection.h"
#include "core/result.h"

#include <array>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// Where a tag should be.
struct ExpectedTag {
    int tag_id;
    std::array<Eigen::Vector2d, 4> corners_px;  ///< in detection order
    double reach_px;                            ///< how far any of them may be off
    TagPrint print = {};
};

struct AlignmentOptions {
    /// Code bits that may differ from the expected code; never so many that they would fit another code as
    /// well: half of the family's least distance.
    int most_wrong_bits = 2;
    double most_wrong_fixed = 1.0 / 7.0;  ///< share of the cells that are alike on every tag
    double least_explained = 0.6;         ///< of the picture inside the outline by the code (tag_pattern.h)
    double least_contrast = 10.0;         ///< between black and white, grey levels
};

/// Finds the outline of an expected tag, and holds what is inside against the expected code.
///
/// On scan lines across each side, from outside inwards, the steepest fall from white to black is the edge
/// (the steepest rise, where the outline is white inside); a
/// line that most scan lines of a side agree on is the side. A side that is hidden is placed by the others (a
/// similarity from the expected outline). The picture inside must then read as the expected code, upright, to
/// within `most_wrong_bits`: what is not surely the expected tag is refused.
///
/// Captures outlines whose sides are within min(reach_px, 0.45 cells) of the expected ones. Corners are good
/// to half a pixel or so: refine_tag() does the rest.
/// Demands a tag of the book. Fails with Reason::no_tag if no such outline is there, wholly inside the image,
/// and with Reason::wrong_tag if it holds something else.
Result<TagDetection> align_tag(const cv::Mat& image, TimeNs time_ns, const ExpectedTag& expected,
                               const AlignmentOptions& options = {});

}  // namespace fidservo::vision
