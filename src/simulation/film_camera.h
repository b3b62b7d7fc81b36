// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/detection.h"
#include "core/plate.h"
#include "plant/view/plate_view.h"
#include "src/simulation/camera_track.h"
#include "vision/tags/tag_detector.h"

#include <deque>
#include <functional>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo {

/// The simulated camera of a run with rendered frames, in which the real detector finds the tags. Needs a rig
/// with camera and fiducials; the plate is the one that the rig file describes.
class FilmCamera {
  public:
    using Keep = std::function<void(TimeNs stamp_ns, const cv::Mat& image)>;

    /// @param keep  receives every frame in turn; it may share the image
    FilmCamera(const Rig& rig, const plant::PlantParameters& parameters, std::uint64_t seed, Keep keep);

    /// Processes the tick that begins at time_ns, under the commands given: renders the frames whose exposure
    /// has ended, and appends the tags in them, with corners refined where the border can be measured.
    void look(const plant::StageState& state, TimeNs time_ns, double macro_V, double micro_V,
              std::vector<TagDetection>& detections);

  private:
    Eigen::Vector2d motion_px(const TagDetection& tag, double middle_s) const;

    CameraParameters camera_;
    plant::PlateView view_;
    CameraTrack track_;
    FrameClock clock_;
    std::int64_t next_frame_ = 0;
    vision::TagDetector detector_;
    Keep keep_;
};

}  // namespace fidservo
