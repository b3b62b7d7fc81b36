#include "src/replay/tag_finder.h"

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

TagFinder::TagFinder(const std::optional<CameraParameters>& camera)
    : camera_(camera), machine_(vision::machine_camera_options()), thorough_(vision::thorough_options()) {}

FrameResult TagFinder::operator()(ReplayFrame frame) {
    const cv::Mat image = decode(frame);
    vision::TagDetector& detector = frame.from_recording ? machine_ : thorough_;
    FrameResult result{.frame = {}, .tags = detector.detect(image, frame.time_ns.value_or(0)), .refined = {}};
    const vision::RefinementOptions options = refinement_for(camera_, image);
    for (TagDetection& tag : result.tags)
        if (const auto refined = vision::refine_tag(image, tag, options)) {
            tag = refined->detection;
            result.refined.push_back(*refined);
        }
    frame.decoded.release();
    result.frame = std::move(frame);
    return result;
}

}  // namespace fidservo
