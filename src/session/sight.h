// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the camera sees of the plate: frame -> tag -> where the camera is.
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
    /// @param nominal  the plate as it should be
    Sight(const CameraParameters& camera, const Plate& nominal);

    /// Where the camera was when the frame was taken. The tag is looked for where the registration says,
    /// around it, and in the whole image, until it is found (vision/tags/tag_tracker.h).
    /// @param expected_s_mm  where the registration believes it to be; chooses the tag by the plate's
    /// geometry
    /// @param preferred_tag  measured by where it is wholly in view
    Result<vision::PositionFit> locate(const vision::Frame& frame, double expected_s_mm,
                                       std::optional<int> preferred_tag = {});
    /// The stage's move from where the camera was in a frame to a target, by the servo law on the tag's
    /// corners.
    vision::ServoMove move_to(const vision::PositionFit& seen, double target_s_mm) const;
    /// Where the camera was, by the plate's tag nearest to the image's middle: for a camera that is lost.
    /// Where several tags are in view, by one that others confirm; fails with wrong_tag if none does.
    Result<vision::PositionFit> locate_anywhere(const vision::Frame& frame);

    /// What was found in the last frame; the tag that it was located by with refined corners.
    const std::vector<TagDetection>& found() const { return found_; }
    /// Of these the one that it was located by, where its corners could be measured.
    const std::vector<TagDetection>& measured() const { return measured_; }

  private:
    vision::ExpectedTag expected(const PlateTag& tag, double s_mm) const;
    void look_for(const vision::Frame& frame, const std::vector<vision::ExpectedTag>& expected);
    /// Id of the tag to locate the camera by; empty if none in view is of the plate.
    Result<std::optional<int>> tag_that_others_confirm() const;
    void keep_refined(const Result<vision::PositionFit>& fit);

    CameraGeometry camera_;
    vision::GreyNoise noise_;
    Plate nominal_;
    vision::TagTracker tracker_;
    std::vector<TagDetection> found_, measured_;
};

}  // namespace fidservo
