// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A fiducial found in a frame, and what it says about where the camera is.
#include "core/tag_families.h"
#include "core/time.h"

#include <array>
#include <optional>

#include <Eigen/Core>

namespace fidservo {

/// The corners of a tag in its own frame, in the order in which detections list them. Tag frame: x to the
/// right, y down on the tag as it is printed, upright; the outline's sides (the black border's outer edge;
/// for other layouts see TagFamily) at +-1.
inline const std::array<Eigen::Vector2d, 4> tag_corners{Eigen::Vector2d(-1, 1), Eigen::Vector2d(1, 1),
                                                        Eigen::Vector2d(1, -1), Eigen::Vector2d(-1, -1)};

/// The 2 x 2 covariance of each corner, px^2. The correlation between corners that share an edge is left out.
using CornerCovariances = std::array<Eigen::Matrix2d, 4>;

/// Corners in px, pixel centres at integers, in plate order: (-,+), (+,+), (+,-), (-,-) in plate x, y. They
/// follow the print: in a mirrored picture they go round the other way, which is the only sign that it is
/// mirrored.
struct TagDetection {
    TimeNs time_ns = 0;                         ///< middle of the frame's exposure
    int tag_id = -1;                            ///< by the code book of the tag's family
    int corrected_bits = 0;                     ///< code bits that differ from the code book
    double decision_margin = 0.0;               ///< contrast between black and white bits, grey levels
    std::array<Eigen::Vector2d, 4> corners_px;  ///< in the order of tag_corners
    TagPrint print;                             ///< family and border that the tag was read as
    /// Whether the corners were fitted along the edges of the tag; false: they are as the detector found
    /// them; empty: not known.
    std::optional<bool> is_refined = {};
    std::optional<CornerCovariances> covariances_px2 = {};  ///< of the corners, where they were measured
};

/// Where the camera is, from one tag whose place on the plate is known.
struct CameraPosition {
    TimeNs time_ns;   ///< middle of the exposure
    int tag_id;       ///< the tag from which this follows
    double s_mm;      ///< plate x under the optical axis
    double s_std_mm;  ///< standard deviation of s_mm
    double y_mm;      ///< plate y under the optical axis; zero on an ideal stage
};

}  // namespace fidservo
