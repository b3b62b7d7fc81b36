// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/pilot.h"

#include "core/rig.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace fidservo {

namespace {

constexpr double frame_timeout_s = 0.5;
constexpr double most_drift_mm = 0.5;  ///< of the registration between two looks

constexpr double rounding_std_count = 0.289;  ///< a count that may be anything up to one half
constexpr double platform_std_mm = 0.005;     ///< of the platform's place by the Hall sensor

CameraWatchParams watch_params(const Rig& rig, double camera_reconnect_s) {
    CameraWatchParams params{1.0 / rig.camera.value().frame_rate_hz};
    params.reconnect_s = camera_reconnect_s;
    params.count_mm = rig.macro.encoder_resolution_mm;
    return params;
}

}  // namespace

Pilot::Pilot(const Rig& of, const Plate& plate, const control::PositionerParams& positioning, Devices devices,
             double camera_reconnect_s)
    : rig(of),
      nominal(plate),
      machine(std::move(devices), watch_params(of, camera_reconnect_s)),
      sight(of.camera.value(), plate),
      params(positioning),
      state(control::positioner_start(params)) {}

double Pilot::believed_s_mm() const {
    return carriage_mm() + state.micro.average_mm;
}

double Pilot::carriage_mm() const {
    return count_zero_mm + static_cast<double>(state.macro.last_count.value_or(0)) * params.count_mm;
}

void Pilot::register_at(double s_mm, int tag_id) {
    const double change_mm = s_mm - believed_s_mm();
    count_zero_mm += change_mm;
    if (registered && std::abs(change_mm) > most_drift_mm)
        spdlog::warn(
            "the camera is {:.3f} mm from where the encoder says: registered anew; did the encoder miss "
            "counts, or was the carriage pushed?",
            change_mm);
    registered = true;
    registered_by = fmt::format("end stop, then tag {}", tag_id);
}

void Pilot::register_at_end_stop(std::int64_t stop_count) {
    count_zero_mm = rig.macro.low_mm - static_cast<double>(stop_count) * params.count_mm;
    registered = false;
    registered_by = "end stop";
    state.macro.last_count = stop_count;
}

std::optional<EncoderZero> Pilot::encoder_zero() const {
    if (!registered) return std::nullopt;
    const double std_count = std::hypot(rounding_std_count, platform_std_mm / params.count_mm);
    return EncoderZero{-count_zero_mm / params.count_mm, std_count, registered_by};
}

control::StageCommand Pilot::command_for(const control::StageSample& sample,
                                         const std::optional<control::TargetOffset>& seen) {
    const auto out = control::positioner_update(params, state, sample, seen);
    wants_frames_ = out.wants_frames;
    return out.command;
}

Status Pilot::catch_up() {
    return machine.catch_up([&](const control::StageSample& sample) { return command_for(sample, {}); },
                            setpoints);
}

Status Pilot::step() {
    return machine.tick([&](const control::StageSample& sample) { return command_for(sample, {}); },
                        setpoints);
}

control::CarriageTravel Pilot::carriage_travel() const {
    return {std::ceil((rig.macro.low_mm - count_zero_mm) / params.count_mm),
            std::floor((rig.macro.high_mm - count_zero_mm) / params.count_mm)};
}

void Pilot::begin_anew() {
    const control::StageSample& last = machine.last_sample();
    state = control::positioner_start(params);
    state.macro.last_count = last.encoder_count;
    state.micro.position_mm = state.micro.average_mm =
        platform_position_mm(params.micro.model, last.hall_adc);
}

Result<vision::Frame> Pilot::next_frame(TimeNs after_ns) {
    const TimeNs whole_ns = after_ns + nanoseconds(0.5 * rig.camera->exposure_s);
    const TimeNs end = machine.now_ns() + nanoseconds(frame_timeout_s);
    while (machine.now_ns() <= end) {
        if (auto stepped = step(); !stepped) return forward(stepped.error());
        auto frame = machine.poll_camera();
        if (!frame) return forward(frame.error());
        if (*frame && exposed_at(**frame) >= whole_ns) return std::move(**frame);
    }
    return failure(Reason::timeout, "no frame from the camera");
}

TimeNs Pilot::exposed_at(const vision::Frame& frame) const {
    return frame.time_ns - nanoseconds(camera_delay_s);
}

Status Pilot::carry_to(double s_mm) {
    if (auto caught = catch_up(); !caught) return caught;
    return carry(s_mm - state.micro.average_mm, params.macro_timeout_s, [&] {
        return control::macro_is_near(state.macro, params.macro_near_count) || carriage_is_quiet();
    });
}

Status Pilot::place_carriage(double carriage_mm) {
    constexpr double nudges_s = 4.0;  // from start to end it takes up to 2 s
    if (auto caught = catch_up(); !caught) return caught;
    auto placed = carry(carriage_mm, nudges_s, [&] { return carriage_is_quiet(); });
    if (placed || placed.error().reason != Reason::timeout) return placed;
    return step_until([&] { return carriage_is_quiet(); }, params.macro_timeout_s,
                      "the macro stage did not come to rest");
}

bool Pilot::carriage_is_quiet() const {
    return control::macro_is_quiet(params.macro, state.macro);
}

Status Pilot::keep_sight(const vision::Frame& frame) {
    return machine.keep(sight.found(),
                        machine.is_recording() ? sight.measured(frame) : std::vector<TagDetection>());
}

Result<vision::PositionFit> Pilot::look_anywhere() {
    const auto frame = next_frame(machine.now_ns());
    if (!frame) return forward(frame.error());
    auto fit = sight.locate_anywhere(*frame);
    if (auto kept = keep_sight(*frame); !kept) return forward(kept.error());
    return fit;
}

/// A frame that has just arrived, as the way still to go.
Result<std::optional<control::TargetOffset>> Pilot::watch(double target_s_mm, int tag_id,
                                                          std::optional<Failure>& trouble) {
    auto frame = machine.poll_camera();
    if (!frame) return forward(frame.error());
    if (!*frame || exposed_at(**frame) < state.rest_since_ns) return std::nullopt;
    const auto fit = sight.locate(**frame, believed_s_mm(), tag_id);
    if (auto kept = keep_sight(**frame); !kept) return forward(kept.error());
    if (!fit) {
        trouble = fit.error();
        return std::nullopt;
    }
    trouble.reset();
    saw(fit->position);
    const vision::ServoMove move = sight.move_to(*fit, target_s_mm);
    return control::TargetOffset{exposed_at(**frame), move.move_mm, move.std_mm};
}

Status Pilot::drive_to(double target_s_mm, int tag_id) {
    if (auto caught = catch_up(); !caught) return caught;
    std::optional<Failure> trouble;
    control::positioner_begin(params, state, target_s_mm - believed_s_mm(), carriage_travel());
    setpoints.macro_mm = target_s_mm - state.micro.average_mm;
    std::optional<control::TargetOffset> seen;
    while (!control::positioner_is_done(state)) {
        bool ticked = false;
        const auto until_it_looks = [&] {
            if (state.micro.phase == control::MicroPhase::approach)
                setpoints.micro_mm = state.micro.target_mm;
            return control::positioner_is_done(state) || (std::exchange(ticked, true) && wants_frames_);
        };
        if (auto moved = move(until_it_looks, std::exchange(seen, std::nullopt)); !moved) return moved;
        if (!wants_frames_) continue;
        auto watched = watch(target_s_mm, tag_id, trouble);
        if (!watched) return forward(watched.error());
        if (auto caught = catch_up(); !caught) return caught;
        seen = *watched;
    }
    if (state.phase == control::PositionerPhase::arrived) {
        register_at(target_s_mm - state.reached.needed_mm, tag_id);
        return {};
    }
    if (trouble) return forward(*trouble);
    if (state.why == Reason::no_tag) return failure(Reason::timeout, "no frame from the camera");
    return failure(state.why,
                   fmt::format("motion to {:.3f} mm ended after {} micro moves", target_s_mm, state.moves));
}

}  // namespace fidservo
