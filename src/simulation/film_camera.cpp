// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/simulation/film_camera.h"

#include "core/rig.h"
#include "src/files/rig/plate_file.h"
#include "vision/tags/tag_refinement.h"

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
    : camera_(*rig.camera),
      view_(view_of(rig, parameters, seed)),
      track_(parameters, 2.0 * view_.reach_s() + 2.0 * parameters.tick_s),
      clock_(rig.camera->frame_rate_hz, *parameters.camera),
      detector_(vision::machine_camera_options({rig.fiducials->print})),
      keep_(std::move(keep)) {}

/// How the picture of a tag moves during the exposure.
Eigen::Vector2d FilmCamera::motion_px(const TagDetection& tag, double middle_s) const {
    const double half_s = 0.5 * camera_.exposure_s;
    const double first_mm = track_.position_mm(middle_s - half_s);
    const double last_mm = track_.position_mm(middle_s + half_s);
    const Eigen::Vector2d place_mm =
        back_project(camera_.geometry, vision::centre_px(tag), 0.5 * (first_mm + last_mm));
    return project(camera_.geometry, place_mm, last_mm) - project(camera_.geometry, place_mm, first_mm);
}

void FilmCamera::look(const plant::StageState& state, TimeNs time_ns, double macro_V, double micro_V,
                      std::vector<TagDetection>& detections) {
    track_.add(state, time_ns, macro_V, micro_V);
    const TimeNs reach_ns = nanoseconds(view_.reach_s());
    for (auto frame = clock_.frame(next_frame_); frame.time_ns + reach_ns <= time_ns;
         frame = clock_.frame(++next_frame_)) {
        const double middle_s = seconds(frame.time_ns);
        const cv::Mat image =
            view_.expose([&](double after_s) { return track_.position_mm(middle_s + after_s); },
                         static_cast<std::uint64_t>(next_frame_), middle_s);
        keep_(frame.stamp_ns, image);
        for (TagDetection& tag : detector_.detect(image, frame.stamp_ns)) {
            // The picture is measured as it is: what the file says of tilt and lens may be what is wrong.
            const auto refined = vision::refine_tag(
                image, tag, {std::nullopt, vision::grey_noise(camera_), motion_px(tag, middle_s)});
            detections.push_back(refined ? refined->detection : vision::unrefined(tag).detection);
        }
    }
}

}  // namespace fidservo
