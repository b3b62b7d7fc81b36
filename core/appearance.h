// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How a fiducial looks in a frame, beside where it is.
#include "core/detection.h"

#include <array>
#include <limits>

#include <Eigen/Core>

namespace fidservo {

/// What could not be measured.
inline constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

/// One side of a tag's black border. Grey levels 0..255 as stored. Standard deviations: by the image's noise.
struct TagSide {
    Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< of the edge in the image, unit length, outward
    /// Second central moment across the edge of its profile's slope, px^2: the pixel's own 1/12, optics and
    /// motion together. Along the normal.
    double variance_px2 = not_measured, variance_std_px2 = not_measured;
    /// The strip of white paper beside the edge: its middle, and the way from there to one of its ends, px.
    Eigen::Vector2d strip_px = Eigen::Vector2d::Zero(), half_strip_px = Eigen::Vector2d::Zero();
    double white_grey = not_measured, white_std_grey = not_measured;  ///< mean over the strip
};

/// Strips of one colour around a tag.
struct GreyNoiseSeen {
    double grey = not_measured;            ///< mean level
    double variance_grey2 = not_measured;  ///< of pixels about an even slope of light; rounding included
    double std_share = not_measured;       ///< standard deviation of that variance, as a share of it
};

/// One tag in one frame. What is saturated, too blurred or outside of the image is not_measured.
struct TagAppearance {
    TimeNs time_ns = 0;            ///< of the frame, as its detection has it
    int tag_id = -1;               ///< which tag
    std::array<TagSide, 4> sides;  ///< from corner k to corner k + 1
    /// Noise of the paper's and of the ink's pixels.
    GreyNoiseSeen white, black;
};

}  // namespace fidservo
