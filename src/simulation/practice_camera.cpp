// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/simulation/practice_camera.h"

#include "core/rig.h"

namespace fidservo {

namespace {

constexpr TimeNs probe_ns = 10'000;  ///< over which the speed is taken

}  // namespace

PracticeCamera::PracticeCamera(const Rig& rig, const plant::PlantParameters& parameters, std::uint64_t seed)
    : parameters_(parameters),
      detector_(*rig.camera, *parameters.camera, *rig.fiducials, seed),
      clock_(rig.camera->frame_rate_hz, *parameters.camera) {
    if (detector_.reach_s() > 0.0)
        track_.emplace(parameters, 2.0 * detector_.reach_s() + 2.0 * parameters.tick_s);
}

void PracticeCamera::detect(const Pending& pending, std::vector<TagDetection>& detections) {
    const double middle_s = seconds(pending.frame.time_ns);
    const auto path = [&](double after_s) {
        if (after_s == 0.0) return pending.s_mm;
        return pending.s_mm + track_->position_mm(middle_s + after_s) - track_->position_mm(middle_s);
    };
    if (const auto seen = detector_.detect(pending.frame.stamp_ns, middle_s, path, pending.speed_mm_per_s))
        detections.push_back(*seen);
}

void PracticeCamera::look(const plant::StageState& state, TimeNs time_ns, double macro_V, double micro_V,
                          std::vector<TagDetection>& detections) {
    if (track_) track_->add(state, time_ns, macro_V, micro_V);
    const TimeNs end_ns = time_ns + nanoseconds(parameters_.tick_s);
    for (auto frame = clock_.frame(next_frame_); frame.time_ns < end_ns;
         frame = clock_.frame(++next_frame_)) {
        const auto there = moved_on(parameters_, state, frame.time_ns - time_ns, macro_V, micro_V);
        const auto after = moved_on(parameters_, there, probe_ns, macro_V, micro_V);
        const double s_mm = plant::camera_position_mm(there);
        pending_.push_back({frame, s_mm, (plant::camera_position_mm(after) - s_mm) / seconds(probe_ns)});
    }
    const auto is_complete = [&](const Pending& pending) {
        return !track_ || pending.frame.time_ns + nanoseconds(detector_.reach_s()) <= time_ns;
    };
    for (; !pending_.empty() && is_complete(pending_.front()); pending_.pop_front())
        detect(pending_.front(), detections);
}

}  // namespace fidservo
