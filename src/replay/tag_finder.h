// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Finds and measures the fiducials in a frame with the best precision available.
#include "core/camera/camera_parameters.h"
#include "core/detection.h"
#include "src/images/image_frame.h"
#include "vision/tags/tag_detector.h"
#include "vision/tags/tag_refinement.h"

#include <optional>
#include <vector>

namespace fidservo {

struct FoundTags {
    std::vector<TagDetection> tags;           ///< all tags, with refined corners where possible
    std::vector<vision::RefinedTag> refined;  ///< those whose border is large and clear enough to be measured
};

struct FrameResult : FoundTags {
    ImageFrame frame;  ///< without its image
    cv::Mat grey;      ///< the image that was searched
};

/// Finds the tags of images; one a thread. Those of a recording are searched as the rig's own camera's, where
/// there is contrast (vision/tags/contrast_regions.h); everything else as photographs, everywhere. Images of
/// the camera's size are taken to be the camera's, if there is one: its geometry and noise then help to
/// measure the tags. What is found in an image depends on that image alone.
class TagFinder {
  public:
    explicit TagFinder(const std::optional<CameraParameters>& camera = {},
                       const vision::TagReading& reading = {});
    /// The detector's tags, without measuring them.
    /// @param image  CV_8UC1
    /// @param is_of_machine  taken by a rig's own camera
    std::vector<TagDetection> detect(const cv::Mat& image, TimeNs time_ns, bool is_of_machine);
    /// Detects tags and measures them.
    FoundTags measure(const cv::Mat& image, TimeNs time_ns, bool is_of_machine);
    /// Decodes a frame first. Throws InputError if it cannot be read.
    FrameResult operator()(ImageFrame frame);

  private:
    std::optional<CameraParameters> camera_;
    vision::TagDetector machine_;
    vision::TagDetector thorough_;
};

}  // namespace fidservo
