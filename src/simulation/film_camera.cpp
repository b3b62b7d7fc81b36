#include "src/simulation/film_camera.h"

#include "src/config/plate_file.h"
#include "vision/tag_refinement.h"

#include <utility>

namespace fidservo {

namespace {

plant::PlateView view_of(const Rig& rig, const plant::PlantParameters& parameters, std::uint64_t seed) {
    plant::ViewOptions options;
    options.seed = seed;
    return {*rig.camera, plate_of(*rig.fiducials), options, *parameters.camera};
}

}  // namespace

FilmCamera::FilmCamera(const Rig& rig, const plant::PlantParameters& parameters, std::uint64_t seed,
                       Keep keep)
    : view_(view_of(rig, parameters, seed)),
      track_(parameters, 2.0 * view_.reach_s() + 2.0 * parameters.tick_s),
      clock_(rig.camera->frame_rate_hz, *parameters.camera),
      keep_(std::move(keep)) {}

void FilmCamera::look(const plant::StageState& state, TimeNs time_ns, double macro_V, double micro_V,
                      std::vector<TagDetection>& detections) {
    track_.add(state, time_ns, macro_V, micro_V);
    const TimeNs reach_ns = nanoseconds(view_.reach_s());
    for (auto frame = clock_.frame(next_frame_); frame.time_ns + reach_ns <= time_ns;
         frame = clock_.frame(++next_frame_)) {
        const double middle_s = seconds(frame.time_ns);
        const cv::Mat image =
            view_.expose([&](double after_s) { return track_.position_mm(middle_s + after_s); },
                         static_cast<std::uint64_t>(next_frame_));
        keep_(frame.stamp_ns, image);
        for (TagDetection& tag : detector_.detect(image, frame.stamp_ns)) {
            const auto refined = vision::refine_tag(image, tag);
            detections.push_back(refined ? refined->detection : tag);
        }
    }
}

}  // namespace fidservo
