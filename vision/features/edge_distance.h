// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The distance between two nearly parallel edges: of two features, or of a feature and a tag.
#include "core/plate.h"
#include "core/result.h"
#include "vision/features/rest_image.h"

#include <optional>
#include <utility>
#include <vector>

namespace fidservo::vision {

/// A straight piece of a feature's outline, nominal, plate frame.
struct NominalEdge {
    Eigen::Vector2d from_mm;
    Eigen::Vector2d to_mm;
    Eigen::Vector2d outward;  ///< unit normal, away from the ink
};

/// The straight edges of a shape's outline: of a line the two long ones, of a tag those of its black border.
std::vector<NominalEdge> edges_of(const Pad& pad);
std::vector<NominalEdge> edges_of(const Line& line);
std::vector<NominalEdge> edges_of(const PlateTag& tag);

/// Of the edges of two outlines, the pair that faces each other across a gap: outward normals opposed within
/// 0.1 rad, overlap along their length, each in front of the other. If there are several pairs, the nearest
/// one; empty if there is none.
std::optional<std::pair<NominalEdge, NominalEdge>> facing_edges(const std::vector<NominalEdge>& a,
                                                                const std::vector<NominalEdge>& b);

struct EdgeDistance {
    Measured distance_um;      ///< at the middle of the overlap, along the mean normal
    Measured inclination_rad;  ///< of edge b against edge a; 0: parallel
    Eigen::Vector2d on_a_mm;   ///< end points of the distance, plate frame
    Eigen::Vector2d on_b_mm;
    EdgeQuality quality_a;
    EdgeQuality quality_b;
};

/// Locates both edges in sections, fits a straight line to each, and computes their distance. The result does
/// not depend on the camera position. Failures are those of measure_dot; the edges must overlap by at least 8
/// px in the image.
Result<EdgeDistance> measure_edge_distance(const RestImage& image, const NominalEdge& a, const NominalEdge& b,
                                           const SearchOptions& options = {});

}  // namespace fidservo::vision
