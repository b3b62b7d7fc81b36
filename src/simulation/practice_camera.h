// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/simulation/camera_track.h"
#include "src/simulation/practice_detections.h"

#include <deque>
#include <optional>
#include <vector>

namespace fidservo {

/// The simulated camera of a run whose detections are not made from images. Where frames fall between ticks,
/// the plant is simulated exactly up to their times. Needs a rig with camera and fiducials.
class PracticeCamera {
  public:
    PracticeCamera(const Rig& rig, const plant::PlantParameters& parameters, std::uint64_t seed);

    /// Processes the tick that begins at time_ns, under the commands given: appends the detections of the
    /// frames that are complete.
    void look(const plant::StageState& state, TimeNs time_ns, double macro_V, double micro_V,
              std::vector<TagDetection>& detections);

  private:
    struct Pending {
        FrameClock::Frame frame;
        double s_mm, speed_mm_per_s;
    };
    void detect(const Pending& pending, std::vector<TagDetection>& detections);

    plant::PlantParameters parameters_;
    PracticeDetector detector_;
    FrameClock clock_;
    std::int64_t next_frame_ = 0;
    std::deque<Pending> pending_;
    std::optional<CameraTrack> track_;  ///< used where a frame's exposure is not taken as an instant
};

}  // namespace fidservo
