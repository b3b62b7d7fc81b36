#pragma once
// Detections that were not made from images: the fiducial nearest to the image centre, its corners with
// noise.
#include "core/detection.h"
#include "core/random.h"
#include "core/rig.h"

#include <cstdint>
#include <optional>

namespace fidservo {

/// What the camera would report at camera position s, as docs/notation.md's practice campaigns have it:
/// nothing while it moves faster than the rig's max_speed_mm_per_s, otherwise the tag of the rig's grid that
/// is nearest to the image centre along the stage axis, if it lies wholly in the image; each corner
/// coordinate with normal noise of corner_noise_px r.m.s.
class PracticeDetector {
  public:
    PracticeDetector(const CameraParameters& camera, const FiducialParameters& fiducials, std::uint64_t seed);

    std::optional<TagDetection> detect(TimeNs time_ns, double s_mm, double speed_mm_per_s);

  private:
    CameraParameters camera_;
    FiducialParameters fiducials_;
    NoiseStream noise_;
};

}  // namespace fidservo
