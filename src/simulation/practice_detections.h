// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Detections that are not made from images: the fiducial nearest to the image centre, its corners with noise.
#include "core/camera/camera_parameters.h"
#include "core/detection.h"
#include "core/fiducial_parameters.h"
#include "core/random.h"
#include "plant/actual_camera.h"

#include <cstdint>
#include <functional>
#include <optional>

namespace fidservo {

/// What the camera would report at camera position s, as docs/notation.md's practice campaigns have it:
/// nothing while it moves faster than the rig's max_speed_mm_per_s, otherwise the tag of the rig's grid that
/// is nearest to what the image's centre shows, if it lies wholly in the image; each corner coordinate with
/// normal noise of corner_noise_px r.m.s.
///
/// Corners are where the true camera sees them, each at the time of its row. The rig file's exposure is taken
/// as an instant; a longer one moves them by the mean position over it less that over the rig file's, and the
/// speed limit falls in proportion.
class PracticeDetector {
  public:
    /// The camera's true position in mm at a time after the frame's, s.
    using Path = std::function<double(double after_s)>;

    PracticeDetector(const CameraParameters& camera, const plant::CameraDeviation& deviation,
                     const FiducialParameters& fiducials, std::uint64_t seed);

    /// @param time_s  of the frame, since the run's first tick
    std::optional<TagDetection> detect(TimeNs stamp_ns, double time_s, const Path& s_mm,
                                       double speed_mm_per_s);

    /// How long before and after a frame's time detect() asks for the position, s; 0: at that time only.
    double reach_s() const;

  private:
    double seen_s_mm(const Path& s_mm, double after_s) const;
    Eigen::Vector2d corner_px(const Eigen::Vector2d& corner_mm, const Path& s_mm) const;

    CameraParameters camera_;
    plant::CameraDeviation deviation_;
    plant::ActualCamera actual_;
    double max_speed_mm_per_s_;
    FiducialParameters fiducials_;
    NoiseStream noise_;
};

}  // namespace fidservo
