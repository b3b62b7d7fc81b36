#include "src/replay/tag_finder.h"

namespace fidservo {

TagFinder::TagFinder() : machine_(vision::machine_camera_options()), thorough_(vision::thorough_options()) {}

FrameResult TagFinder::operator()(ReplayFrame frame) {
    const cv::Mat image = decode(frame);
    vision::TagDetector& detector = frame.from_recording ? machine_ : thorough_;
    FrameResult result{.frame = {}, .tags = detector.detect(image, frame.time_ns.value_or(0)), .refined = {}};
    for (TagDetection& tag : result.tags)
        if (const auto refined = vision::refine_tag(image, tag)) {
            tag = refined->detection;
            result.refined.push_back(*refined);
        }
    frame.decoded.release();
    result.frame = std::move(frame);
    return result;
}

}  // namespace fidservo
