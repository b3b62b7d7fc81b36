// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How far tags moved in the image since they were first seen, in um. This needs no rig file: the tag's own
// side gives the scale.
#include "core/detection.h"
#include "vision/tags/tag_refinement.h"

#include <vector>

#include <Eigen/Core>

namespace fidservo::vision {

/// Motion of a tag in the image: dx to the right, dy down. A camera that moves right (s grows) over a plate
/// at rest sees its tags move left: dx = -(s - s_first).
struct Displacement {
    TimeNs time_ns;            ///< middle of the frame's exposure
    int tag_id;                ///< which tag
    Eigen::Vector2d moved_um;  ///< displacement from where the tag was first seen
    /// Standard deviation, from both centres and, over long distances, from the scale.
    Eigen::Vector2d std_um;
};

/// The properties of a tag in a frame from which its displacement follows.
struct TagPlace {
    TimeNs time_ns;                ///< middle of the frame's exposure
    int tag_id;                    ///< which tag
    Eigen::Vector2d centre_px;     ///< in the image
    Eigen::Vector2d variance_px2;  ///< of the centre, along u and v
    double side_px, side_std_px;   ///< mean length of its sides, and its standard deviation
};
/// The place of a measured tag.
TagPlace tag_place(const RefinedTag& tag);

/// Turns detections, frame after frame, into displacements from the frame in which each tag was first seen.
/// Scale: the tag's mean side in the first frame, mm per px. Valid for a camera that looks straight at the
/// plate. A tag id that is seen twice in one frame is left out in it, as it is ambiguous.
class DisplacementTracker {
  public:
    /// @param tag_side_mm  edge of the black border square
    explicit DisplacementTracker(double tag_side_mm);

    /// @param frame  all tags of one frame
    std::vector<Displacement> add(const std::vector<RefinedTag>& frame);
    /// The same for places that were computed before.
    std::vector<Displacement> add(const std::vector<TagPlace>& frame);

  private:
    struct Origin {
        int tag_id;
        Eigen::Vector2d centre_px;
        Eigen::Vector2d variance_px2;
        double um_per_px;
        double relative_scale_std;
    };
    double tag_side_mm_;
    std::vector<Origin> origins_;
};

}  // namespace fidservo::vision
