// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/live_rig.h"

#include "core/monotonic_clock.h"
#include "core/rig.h"

#include <algorithm>

namespace fidservo {

LiveRig::LiveRig(const Rig& rig, const Plate& printed, double carriage_mm, std::uint64_t seed,
                 std::span<const plant::EffectSetting> effects)
    : plant_(plant::make_stage_plant(rig, effects)),
      view_(rig.camera.value(), printed, {}, plant_.camera.value_or(plant::CameraDeviation{})),
      state_(plant::start(plant_, carriage_mm, seed)),
      tick_ns_(nanoseconds(rig.tick_s)),
      start_ns_(monotonic_now_ns()) {
    past_mm_.fill(plant::camera_position_mm(state_));
}

void LiveRig::go_on_to(TimeNs now_ns) {
    for (const std::int64_t due = (now_ns - start_ns_) / tick_ns_; tick_ < due;) {
        plant::advance(plant_, state_, macro_V_, micro_V_);
        past_mm_[static_cast<std::size_t>(++tick_) % past_mm_.size()] = plant::camera_position_mm(state_);
    }
}

void LiveRig::command(double macro_V, double micro_V) {
    const std::lock_guard lock(mutex_);
    go_on_to(monotonic_now_ns());
    macro_V_ = macro_V;
    micro_V_ = micro_V;
}

plant::StageReading LiveRig::read(TimeNs now_ns) {
    const std::lock_guard lock(mutex_);
    go_on_to(now_ns);
    return plant::sample(plant_, state_);
}

plant::StageReading LiveRig::follow(double macro_V, double micro_V, TimeNs now_ns) {
    const std::lock_guard lock(mutex_);
    macro_V_ = macro_V;
    micro_V_ = micro_V;
    is_followed_ = true;
    go_on_to(now_ns);
    return plant::sample(plant_, state_);
}

double LiveRig::camera_at(TimeNs time_ns) const {
    const double tick = std::clamp(static_cast<double>(time_ns - start_ns_) / static_cast<double>(tick_ns_),
                                   0.0, static_cast<double>(tick_));
    const auto before = static_cast<std::size_t>(tick);
    const double part = tick - static_cast<double>(before);
    const double from_mm = past_mm_[before % past_mm_.size()];
    return from_mm + part * (past_mm_[(before + 1) % past_mm_.size()] - from_mm) * (part > 0.0);
}

double LiveRig::camera_mm(TimeNs time_ns) {
    const std::lock_guard lock(mutex_);
    if (!is_followed_) go_on_to(monotonic_now_ns());
    return camera_at(time_ns);
}

double LiveRig::carriage_mm() {
    const std::lock_guard lock(mutex_);
    return state_.axis.position_mm;
}

cv::Mat LiveRig::frame_at(TimeNs time_ns, std::uint64_t frame) {
    return view_.expose([&](double after_s) { return camera_mm(time_ns + nanoseconds(after_s)); }, frame);
}

}  // namespace fidservo
