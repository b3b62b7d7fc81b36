// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The camera's view of the plate: from a frame to a tag to the camera's position.
#include "core/camera/camera_parameters.h"
#include "core/plate.h"
#include "core/result.h"
#include "vision/camera_position.h"
#include "vision/servo/servo_law.h"
#include "vision/tags/tag_tracker.h"

#include <optional>
#include <vector>

namespace fidservo {

class Sight {
  public:
    /// @param nominal  the nominal plate
    Sight(const CameraParameters& camera, const Plate& nominal);

    /// Where the camera was when the frame was taken. The tag is looked for where the registration says,
    /// around it, and in the whole image, until it is found (vision/tags/tag_tracker.h).
    /// @param expected_s_mm  position by the registration, which determines the tag to be used
    /// @param preferred_tag  used if it is completely in view
    Result<vision::PositionFit> locate(const vision::Frame& frame, double expected_s_mm,
                                       std::optional<int> preferred_tag = {});
    /// The stage's move from where the camera was in a frame to a target, by the servo law on the tag's
    /// corners.
    vision::ServoMove move_to(const vision::PositionFit& seen, double target_s_mm) const;
    /// Where the camera was, by the plate's tag nearest to the image's middle: for when the position is
    /// unknown. Where several tags are in view, one is used that others confirm; fails with wrong_tag if none
    /// does.
    Result<vision::PositionFit> locate_anywhere(const vision::Frame& frame);

    /// The tags found in the last frame; the one used for the position has refined corners.
    const std::vector<TagDetection>& found() const { return found_; }
    /// Of these the one used for the position, if its corners could be measured; as the picture shows them,
    /// not as the camera of the rig file would have to: a recording of them can contradict that camera.
    /// It is measured once more for that, with all eight coordinates of its corners free.
    /// @param frame  the last one
    std::vector<TagDetection> measured(const vision::Frame& frame) const;

  private:
    vision::ExpectedTag expected(const PlateTag& tag, double s_mm) const;
    void look_for(const vision::Frame& frame, const std::vector<vision::ExpectedTag>& expected);
    /// Id of the tag to be used for the position; empty if no tag in view is of the plate.
    Result<std::optional<int>> tag_that_others_confirm() const;
    void keep_refined(const Result<vision::PositionFit>& fit);

    CameraGeometry camera_;
    vision::GreyNoise noise_;
    Plate nominal_;
    vision::TagTracker tracker_;
    std::vector<TagDetection> found_;
    std::optional<vision::RefinedTag> refined_;  ///< in the last frame, if its corners could be measured
};

}  // namespace fidservo
