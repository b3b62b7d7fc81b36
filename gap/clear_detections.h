#pragma once
// Which detections say where a tag was.
#include "core/recording.h"
#include "core/rig.h"

#include <span>

namespace fidservo::gap {

/// Takes out of a recording the detections that say little of where the tag was: those of frames in which it
/// moves by more than 0.15 cells while they are exposed, by the carriage's velocity (one value a row) and by
/// where the frames before and after show it; those that one of these frames does not show; and those nearer
/// than half a cell to the image's border, which may have cut it.
void drop_unclear(Recording& recording, std::span<const double> velocity_mm_per_s,
                  const CameraParameters& camera, const FiducialParameters& fiducials, double exposure_s);

}  // namespace fidservo::gap
