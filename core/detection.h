// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A fiducial found in a frame, and what it says about where the camera is.
#include "core/tag_families.h"
#include "core/time.h"

#include <array>
#include <optional>

#include <Eigen/Core>

namespace fidservo {

/// The corners of the tag's own square, in the order in which detections list them. Tag frame: x to the
/// right, y down on the tag as it is printed, upright; the outline's sides (the black border's outer edge;
/// for other layouts see TagFamily) at +-1.
inline const std::array<Eigen::Vector2d, 4> tag_corners{Eigen::Vector2d(-1, 1), Eigen::Vector2d(1, 1),
                                                        Eigen::Vector2d(1, -1), Eigen::Vector2d(-1, -1)};

/// Of each corner by itself, px^2. Corners that share an edge are off together, which is left out here.
using CornerCovariances = std::array<Eigen::Matrix2d, 4>;

/// Corners in px, pixel centres at integers, in plate order: (-,+), (+,+), (+,-), (-,-) in plate x, y. They
/// are those of the print: in a mirrored picture they go round the other way, and only by that it is known as
/// one.
struct TagDetection {
    TimeNs time_ns = 0;                         ///< middle of the frame's exposure
    int tag_id = -1;                            ///< by the family's code book
    int corrected_bits = 0;                     ///< code bits that differ from the code book
    double decision_margin = 0.0;               ///< contrast between black and white bits, grey levels
    std::array<Eigen::Vector2d, 4> corners_px;  ///< in the order of tag_corners
    TagPrint print;                             ///< as which it was read
    /// Whether the corners were measured along the edges of the tag, or are as the detector found them;
    /// empty: not known.
    std::optional<bool> is_refined = {};
    std::optional<CornerCovariances> covariances_px2 = {};  ///< of the corners, where they were measured
};

/// Where the camera is, from one tag whose place on the plate is known.
struct CameraPosition {
    TimeNs time_ns;   ///< middle of the exposure
    int tag_id;       ///< which tag told it
    double s_mm;      ///< plate x under the optical axis
    double s_std_mm;  ///< one standard deviation
    double y_mm;      ///< plate y under the optical axis; zero on an ideal stage
};

}  // namespace fidservo
