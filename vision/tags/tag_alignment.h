// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Finds a tag whose position in the image is roughly known, without a search of the whole image.
#include "core/detection.h"
#include "core/result.h"

#include <array>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// Where a tag should be.
struct ExpectedTag {
    int tag_id;
    std::array<Eigen::Vector2d, 4> corners_px;  ///< in the order of detections
    double reach_px;                            ///< largest error of any of these corners, px
    TagPrint print = {};
};

struct AlignmentOptions {
    /// Largest number of code bits that may be wrong; in any case fewer than half of the family's least
    /// distance, so that the pattern is nearest to the expected code.
    int most_wrong_bits = 2;
    /// Largest fraction of wrong cells among those that are the same on every tag of the family (border,
    /// fixed cells).
    double most_wrong_fixed = 1.0 / 7.0;
    /// Least fraction of the variance inside the outline that the code must explain (tag_pattern.h).
    double least_explained = 0.6;
    double least_contrast = 10.0;  ///< between black and white, grey levels
};

/// Finds the outline of an expected tag, and compares what is inside with the expected code.
///
/// On scan lines across each side, from outside inwards, the steepest fall from white to black is the edge
/// (the steepest rise, where the outline is white inside); the line through the edge points of most of its
/// scan lines is the side. A hidden side is inferred from the others (by a similarity from the expected
/// outline). The picture inside must then be the expected code, upright, to within `most_wrong_bits`;
/// otherwise the tag is refused.
///
/// Captures outlines whose sides are within min(reach_px, 0.45 cells) of the expected ones. Corners are
/// accurate to about half a pixel; refine_tag() improves them. Demands an id of the family. Fails with
/// Reason::no_tag if no such outline is there, wholly inside the image, and with Reason::wrong_tag if the
/// outline holds another pattern.
Result<TagDetection> align_tag(const cv::Mat& image, TimeNs time_ns, const ExpectedTag& expected,
                               const AlignmentOptions& options = {});

}  // namespace fidservo::vision
