// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/replay/tag_finder.h"

#include "core/camera/camera_parameters.h"
#include "vision/tags/contrast_regions.h"

#include <algorithm>

namespace fidservo {

namespace {

vision::RefinementOptions refinement_for(const std::optional<CameraParameters>& camera,
                                         const cv::Mat& image) {
    vision::RefinementOptions options;
    if (camera && image.cols == camera->geometry.width_px && image.rows == camera->geometry.height_px) {
        options.camera = camera->geometry;
        options.noise = vision::grey_noise(*camera);
    }
    return options;
}

}  // namespace

TagFinder::TagFinder(const std::optional<CameraParameters>& camera, const vision::TagReading& reading)
    : camera_(camera),
      machine_(vision::machine_camera_options(reading)),
      thorough_(vision::thorough_options(reading)) {}

std::vector<TagDetection> TagFinder::detect(const cv::Mat& image, TimeNs time_ns, bool is_of_machine) {
    if (!is_of_machine) return thorough_.detect(image, time_ns);
    std::vector<TagDetection> tags;
    for (const cv::Rect& region :
         vision::contrast_regions(image, vision::machine_camera_options().min_contrast)) {
        const auto found = machine_.detect(image, time_ns, region);
        tags.insert(tags.end(), found.begin(), found.end());
    }
    std::sort(tags.begin(), tags.end(), vision::by_id_from_left);
    return tags;
}

FoundTags TagFinder::measure(const cv::Mat& image, TimeNs time_ns, bool is_of_machine) {
    FoundTags found{.tags = detect(image, time_ns, is_of_machine), .refined = {}};
    const vision::RefinementOptions options = refinement_for(camera_, image);
    for (TagDetection& tag : found.tags) {
        const auto refined = vision::refine_tag(image, tag, options);
        tag = refined ? refined->detection : vision::unrefined(tag).detection;
        if (refined) found.refined.push_back(*refined);
    }
    return found;
}

FrameResult TagFinder::operator()(ImageFrame frame) {
    const cv::Mat image = decode(frame);
    FrameResult result{measure(image, frame.time_ns.value_or(0), frame.from_recording), {}, image};
    frame.decoded.release();
    result.frame = std::move(frame);
    return result;
}

}  // namespace fidservo
