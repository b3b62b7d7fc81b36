// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/simulation/camera_track.h"

#include "core/demand.h"

#include <algorithm>
#include <cmath>

namespace fidservo {

namespace {

constexpr TimeNs first_frame_ns = 3'300'000;

plant::StagePlant plant_of_tick(plant::PlantParameters parameters, double tick_s) {
    parameters.tick_s = tick_s;
    return plant::make_stage_plant(parameters);
}

}  // namespace

FrameClock::FrameClock(double frame_rate_hz, const plant::CameraDeviation& camera)
    : period_ns_(nanoseconds(1.0 / frame_rate_hz)), camera_(camera) {}

FrameClock::Frame FrameClock::frame(std::int64_t index) const {
    const TimeNs shown_ns = first_frame_ns + index * period_ns_;
    const TimeNs time_ns = std::llround(static_cast<double>(shown_ns) / camera_.clock_rate);
    return {time_ns, shown_ns + nanoseconds(plant::stamp_delay_s(camera_, seconds(time_ns)))};
}

plant::StageState moved_on(const plant::PlantParameters& parameters, plant::StageState state, TimeNs way_ns,
                           double macro_V, double micro_V) {
    if (way_ns <= 0) return state;
    plant::advance(plant_of_tick(parameters, seconds(way_ns)), state, macro_V, micro_V);
    return state;
}

CameraTrack::CameraTrack(const plant::PlantParameters& parameters, double keep_s)
    : half_tick_(plant_of_tick(parameters, 0.5 * parameters.tick_s)),
      tick_s_(parameters.tick_s),
      ticks_(static_cast<std::size_t>(std::ceil(keep_s / tick_s_)) + 3) {}

void CameraTrack::add(const plant::StageState& state, TimeNs time_ns, double macro_V, double micro_V) {
    last_ = std::llround(seconds(time_ns) / tick_s_);
    plant::StageState middle = state;
    plant::advance(half_tick_, middle, macro_V, micro_V);
    ticks_[static_cast<std::size_t>(last_) % ticks_.size()] = {plant::camera_position_mm(state),
                                                               plant::camera_position_mm(middle)};
}

double CameraTrack::position_mm(double time_s) const {
    const double tick = std::max(0.0, time_s / tick_s_);
    const auto before = std::min(static_cast<std::int64_t>(tick), last_ - 1);
    FIDSERVO_DEMAND(tick <= static_cast<double>(last_) + 1e-6 &&
                    last_ - before < static_cast<std::int64_t>(ticks_.size()));
    if (before < 0) return ticks_[0].start_mm;
    const Tick& here = ticks_[static_cast<std::size_t>(before) % ticks_.size()];
    const double end_mm = ticks_[static_cast<std::size_t>(before + 1) % ticks_.size()].start_mm;
    const double x = tick - static_cast<double>(before);
    const double straight = end_mm - here.start_mm;
    const double bend = 4.0 * (here.middle_mm - here.start_mm - 0.5 * straight);
    return here.start_mm + x * (straight + (1.0 - x) * bend);
}

}  // namespace fidservo
