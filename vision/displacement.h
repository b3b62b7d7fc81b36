// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How far tags moved in the image since they were first seen, in um. Needs no rig: the tag's own side is the
// scale.
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
    Eigen::Vector2d moved_um;  ///< from where it was first seen
    Eigen::Vector2d std_um;    ///< of the two centres and, far from the start, of the scale
};

/// What of a tag in a frame its displacement depends on.
struct TagPlace {
    TimeNs time_ns;                ///< middle of the frame's exposure
    int tag_id;                    ///< which tag
    Eigen::Vector2d centre_px;     ///< in the image
    Eigen::Vector2d variance_px2;  ///< of the centre, along u and v
    double side_px, side_std_px;   ///< mean length of its sides, one standard deviation of it
};
/// Of a tag as it was measured.
TagPlace tag_place(const RefinedTag& tag);

/// Turns detections, frame after frame, into displacements from the frame in which each tag was first seen.
/// Scale: the tag's mean side in the first frame, mm per px. Valid for a camera that looks straight at
/// the plate. A tag that is seen twice in one frame is left out there: nobody knows which one moved.
class DisplacementTracker {
  public:
    /// @param tag_side_mm  edge of the black border square
    explicit DisplacementTracker(double tag_side_mm);

    /// @param frame  all tags of one frame
    std::vector<Displacement> add(const std::vector<RefinedTag>& frame);
    /// The same of places that were kept.
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
