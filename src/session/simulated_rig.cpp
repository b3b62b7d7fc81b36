// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/simulated_rig.h"

#include "core/demand.h"
#include "core/failure.h"
#include "core/input_error.h"
#include "core/rig.h"
#include "src/session/state_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace fidservo {

namespace {

constexpr double first_frame_s = 0.0033;

/// Somewhere on the rail, away from its ends: nothing is known of it before homing.
double start_position_mm(const plant::PlantParameters& physics, std::uint64_t seed) {
    const double low = std::max(physics.axis.low_mm, -1e3), high = std::min(physics.axis.high_mm, 1e3);
    return low + (high - low) * (0.1 + 0.8 * NoiseStream(seed, "start position").uniform());
}

plant::ViewOptions view_options(std::uint64_t seed) {
    plant::ViewOptions options;
    options.seed = seed;
    return options;
}

}  // namespace

SimulatedRig::SimulatedRig(const plant::PlantParameters& physics, const CameraParameters& camera,
                           const Plate& printed, std::uint64_t seed)
    : plant_(plant::make_stage_plant(physics)),
      camera_(camera),
      view_(camera, printed, view_options(seed), physics.camera.value_or(plant::CameraDeviation{})),
      state_(plant::start(plant_, start_position_mm(physics, seed), seed)),
      tick_ns_(nanoseconds(plant_.tick_s)) {
    past_mm_.fill(plant::camera_position_mm(state_));
}

control::StageSample SimulatedRig::read() {
    const plant::StageReading reading = plant::sample(plant_, state_);
    return {now_ns(), reading.encoder_count, reading.hall_adc};
}

void SimulatedRig::write(const control::StageCommand& command) {
    plant::advance(plant_, state_, command.macro_V, command.micro_V);
    ++tick_;
    past_mm_[static_cast<std::size_t>(tick_) % past_mm_.size()] = plant::camera_position_mm(state_);
}

double SimulatedRig::position_mm(double time_s) const {
    const double tick = std::max(0.0, time_s / plant_.tick_s);
    const auto before = static_cast<std::size_t>(tick);
    const double part = tick - static_cast<double>(before);
    const double from_mm = past_mm_[before % past_mm_.size()];
    return from_mm + part * (past_mm_[(before + 1) % past_mm_.size()] - from_mm);
}

std::optional<vision::Frame> SimulatedRig::poll() {
    const plant::CameraDeviation deviation = plant_.camera.value_or(plant::CameraDeviation{});
    const double delay_s = plant::stamp_delay_s(deviation, seconds(now_ns()));
    const double link_s = std::max(camera_.latency_s, view_.reach_s()) + delay_s;
    const double shown_s = (seconds(now_ns()) - link_s) * deviation.clock_rate;
    const auto frame =
        static_cast<std::int64_t>(std::floor((shown_s - first_frame_s) * camera_.frame_rate_hz + 1e-9));
    if (frame < next_frame_) return std::nullopt;
    next_frame_ = frame + 1;
    const double stamp_s = first_frame_s + static_cast<double>(frame) / camera_.frame_rate_hz;
    const double middle_s = stamp_s / deviation.clock_rate;
    FIDSERVO_DEMAND(seconds(now_ns()) - middle_s <
                    0.9 * plant_.tick_s * static_cast<double>(past_mm_.size()));
    vision::Frame result;
    result.image = view_.expose([&](double after_s) { return position_mm(middle_s + after_s); },
                                static_cast<std::uint64_t>(frame), middle_s);
    result.time_ns = nanoseconds(stamp_s + delay_s);
    result.arrival_ns = nanoseconds(middle_s + link_s);
    result.sequence = static_cast<std::uint64_t>(frame);
    return result;
}

std::string SimulatedRig::snapshot() const {
    const nlohmann::json json{
        {"state", json_of(state_)}, {"tick", tick_}, {"next_frame", next_frame_}, {"past_mm", past_mm_}};
    return json.dump();
}

void SimulatedRig::restore(const std::string& snapshot) {
    const auto json = nlohmann::json::parse(snapshot);
    read_json(json.at("state"), state_);
    json.at("tick").get_to(tick_);
    json.at("next_frame").get_to(next_frame_);
    json.at("past_mm").get_to(past_mm_);
}

Result<control::StageSample> SimulatedStage::read() {
    return rig_->read();
}

Status SimulatedStage::write(const control::StageCommand& command) {
    if (guardian_) {
        if (const auto why = guardian_->tripped())
            return failure(Reason::stopped, "the guardian switched the stage off: " + *why);
        guardian_->apply(command);
    }
    try {
        rig_->write(command);
    } catch (const InputError& error) {
        return failure(Reason::device, error.what());  // forces that no machine has
    }
    return {};
}

Result<std::optional<vision::Frame>> SimulatedCamera::poll(TimeNs) {
    return rig_->poll();
}

}  // namespace fidservo
