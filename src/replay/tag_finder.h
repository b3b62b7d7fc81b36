// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From a frame to its fiducials, as precise as they can be had.
#include "core/camera/camera_parameters.h"
#include "core/detection.h"
#include "src/images/image_frame.h"
#include "vision/tags/tag_detector.h"
#include "vision/tags/tag_refinement.h"

#include <optional>
#include <vector>

namespace fidservo {

struct FrameResult {
    ImageFrame frame;                         ///< without its image
    cv::Mat grey;                             ///< the image that was searched
    std::vector<TagDetection> tags;           ///< all, with refined corners where there are any
    std::vector<vision::RefinedTag> refined;  ///< those whose border is large and clear enough to be measured
};

/// Decodes a frame and finds its tags; one a thread. Recordings are searched as the rig's own camera's, where
/// there is contrast (vision/tags/contrast_regions.h); everything else as photographs, everywhere. Frames of
/// the camera's size are taken to be the camera's, if there is one: its geometry and noise then help to
/// measure the tags. What is found in a frame depends on that frame alone.
class TagFinder {
  public:
    explicit TagFinder(const std::optional<CameraParameters>& camera = {},
                       const vision::TagReading& reading = {});
    /// Throws InputError if the frame cannot be read.
    FrameResult operator()(ImageFrame frame);

  private:
    std::vector<TagDetection> find(const cv::Mat& image, const ImageFrame& frame);

    std::optional<CameraParameters> camera_;
    vision::TagDetector machine_;
    vision::TagDetector thorough_;
};

}  // namespace fidservo
