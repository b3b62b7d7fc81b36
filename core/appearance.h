// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How a fiducial looks in a frame: sharpness, brightness and noise, besides its corners' places.
#include "core/detection.h"

#include <array>
#include <limits>

#include <Eigen/Core>

namespace fidservo {

/// The value of a number that could not be measured: NaN.
inline constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

/// One side of a tag's black border. Grey levels are 0..255 as stored; the standard deviations follow from
/// the image's noise.
struct TagSide {
    Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< of the edge in the image, unit length, outward
    /// Second central moment, px^2, of the edge's line spread function (the slope of its profile), taken
    /// along the normal: the pixel's own 1/12, the optics' blur and the motion's together.
    double variance_px2 = not_measured, variance_std_px2 = not_measured;
    /// The strip of white paper beside the edge: its middle, and the vector from there to one of its ends,
    /// px.
    Eigen::Vector2d strip_px = Eigen::Vector2d::Zero(), half_strip_px = Eigen::Vector2d::Zero();
    double white_grey = not_measured, white_std_grey = not_measured;  ///< mean over the strip
};

/// The noise seen in the strips of one colour around a tag.
struct GreyNoiseSeen {
    double grey = not_measured;  ///< mean level
    /// Variance of the pixels about a linear gradient of light; rounding included.
    double variance_grey2 = not_measured;
    double std_share = not_measured;  ///< standard deviation of the variance's estimate, as a fraction of it
};

/// One tag in one frame. A number is not_measured where the tag is saturated, too blurred or outside of the
/// image.
struct TagAppearance {
    TimeNs time_ns = 0;            ///< of the frame, as its detection has it
    int tag_id = -1;               ///< which tag
    std::array<TagSide, 4> sides;  ///< from corner k to corner k + 1
    /// Noise of the paper's and of the ink's pixels around the tag.
    GreyNoiseSeen white, black;
};

}  // namespace fidservo
