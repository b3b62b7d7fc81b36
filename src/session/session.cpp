// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/session.h"

#include "core/camera/camera_covariance.h"
#include "core/failure.h"
#include "core/input_error.h"
#include "core/rig.h"
#include "core/units.h"
#include "src/files/recording/layout.h"
#include "src/files/recording/utc_time.h"
#include "src/files/rig/plate_file.h"
#include "src/process/interrupt.h"
#include "src/session/camera_choice.h"
#include "src/session/devices.h"
#include "src/session/home.h"
#include "src/session/motion_params.h"
#include "src/session/rig_check.h"
#include "src/session/simulated_rig.h"
#include "src/session/stage_choice.h"
#include "src/session/stage_start.h"
#include "src/session/state_json.h"
#include "vision/tags/tag_choice.h"
#include "vision/tags/tag_refinement.h"

#include <array>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace fidservo {

namespace {

constexpr double still_mm = 0.002;  ///< of the platform, by the Hall sensor, while a frame is taken
constexpr double misplaced_mm =
    0.3;  ///< a camera that is where it should be sees another tag: the plate's fault

/// What the camera's calibration leaves of its way from above a fiducial to dx beside it.
double calibration_std_mm(const CameraParameters& camera, double dx_mm) {
    const auto seen_from = [&](double s_mm) {
        return project(camera.geometry, Eigen::Vector2d::Zero(), s_mm);
    };
    return std::sqrt(vector_covariance_mm2(camera.geometry, camera.geometry_covariance, seen_from(0.0),
                                           seen_from(dx_mm), 0.0)(0, 0));
}

RecordingOrigin origin_of(const SessionOptions& options) {
    RecordingOrigin origin = options.origin;
    origin.stage = options.stage;
    origin.camera = options.camera;
    origin.program = this_program();
    return origin;
}

}  // namespace

struct Session::Impl {
    Impl(const SessionOptions& options, const Rig& rig, const Plate& nominal,
         const control::PositionerParams& params, Devices devices)
        : pilot(rig, nominal, params, std::move(devices), options.camera_reconnect_s),
          origin(origin_of(options)),
          states_time(options.recordings_state_time) {}

    Status drive_or_search(double target_s_mm, int tag_id);
    void take_up(const nlohmann::json& checkpoint);

    Pilot pilot;
    std::shared_ptr<SimulatedRig> simulated;
    std::shared_ptr<control::Guardian> guardian;
    const RecordingOrigin origin;
    const bool states_time;
    KeepFrames keep_frames = KeepFrames::no;
};

/// Where the fiducial is not found, or another one is in its place, the camera looks about; what it sees
/// there corrects the registration.
Status Session::Impl::drive_or_search(double target_s_mm, int tag_id) {
    Status driven = pilot.drive_to(target_s_mm, tag_id);
    for (const double offset_mm : search_offsets_mm) {
        const bool lost = !driven && (driven.error().reason == Reason::no_tag ||
                                      driven.error().reason == Reason::wrong_tag);
        if (!lost) break;
        if (offset_mm != 0.0)
            if (auto carried = pilot.carry_to(target_s_mm + offset_mm); !carried) return carried;
        const auto fit = pilot.look_anywhere();
        if (!fit && ends_the_run(fit.error().reason)) return forward(fit.error());
        if (!fit) continue;
        const double wrong_mm = fit->position.s_mm - pilot.believed_s_mm();
        if (driven.error().reason == Reason::wrong_tag && std::abs(wrong_mm) < misplaced_mm) break;
        pilot.register_at(fit->position.s_mm, fit->position.tag_id);
        driven = pilot.drive_to(target_s_mm, tag_id);
    }
    return driven;
}

Session::Session(const SessionOptions& options, const Rig& rig, const Plate& nominal, Devices devices)
    : impl_(std::make_unique<Impl>(options, rig, nominal,
                                   positioner_params(rig, mm_from_um(options.tolerance_um)),
                                   std::move(devices))) {}

Session::Session(const SessionOptions& options, const Rig& rig, const Plate& nominal, const Plate& printed) {
    const auto params =
        positioner_params(rig, mm_from_um(options.tolerance_um));  // refuses before devices are touched
    RigDevices devices = make_devices(options, rig, printed);
    impl_ = std::make_unique<Impl>(options, rig, nominal, params,
                                   Devices{devices.stage, devices.camera, devices.loop});
    impl_->simulated = std::move(devices.simulated);
    impl_->guardian = std::move(devices.guardian);
    if (!stage_is_simulated(options)) check_stage(impl_->pilot);
}

Session::~Session() {
    (void)impl_->pilot.machine.switch_off();
    const vision::FrameCounts frames = frame_counts();
    if (frames.lost + frames.damaged + frames.reconnects > 0) spdlog::warn("camera: {}", text_of(frames));
    if (const auto loop = loop_statistics()) spdlog::info("control loop: {}", text_of(*loop));
    if (!impl_->guardian) return;
    if (const auto off = impl_->guardian->finish(); !off) spdlog::error("{}", off.error().text);
}

void Session::record_to(const std::filesystem::path& folder, const std::string& experiment,
                        KeepFrames keep_frames) {
    RecordingOptions recording;
    recording.name = folder.filename().string();
    recording.experiment = experiment;
    recording.controllers =
        ControllerNames{std::string(controller_name::positioner), std::string(controller_name::positioner)};
    recording.frames = keep_frames == KeepFrames::yes;
    record_to(folder, std::move(recording));
}

void Session::record_to(const std::filesystem::path& folder, RecordingOptions recording) {
    const Rig& rig = impl_->pilot.rig;
    impl_->keep_frames = recording.frames ? KeepFrames::yes : KeepFrames::no;
    recording.rig = rig.name;
    recording.tick_s = rig.tick_s;
    recording.encoder_zero = impl_->pilot.encoder_zero();
    const std::string request_sha256 = std::move(recording.origin.request_sha256);
    recording.origin = impl_->origin;
    recording.origin.request_sha256 = request_sha256;
    if (impl_->states_time) recording.origin.recorded_at = utc_now();
    recording.columns = columns_of(rig);
    recording.camera = rig.camera;
    recording.corners = CornerColumns::places_and_covariances;
    if (!rig.fiducials || impl_->pilot.nominal.tags != plate_of(*rig.fiducials).tags)
        recording.plate = impl_->pilot.nominal.tags;
    recording.when_full = loop_statistics() || impl_->simulated ? WhenFull::wait : WhenFull::fail;
    impl_->pilot.machine.record_to(std::make_unique<RecordingWriter>(folder, recording));
}

Status Session::end_recording() {
    return impl_->pilot.machine.end_recording(impl_->pilot.encoder_zero());
}

void Session::leave_recording() {
    impl_->pilot.machine.leave_recording(impl_->pilot.encoder_zero());
}

Status Session::home() {
    return fidservo::home(impl_->pilot);
}

Result<Arrival> Session::go_to(int tag_id, double dx_mm) {
    Pilot& pilot = impl_->pilot;
    const auto tag = vision::find_tag(pilot.nominal, tag_id);
    if (!tag) return failure(Reason::wrong_tag, fmt::format("tag {} is not on the plate", tag_id));
    const double target_s_mm = tag->centre_mm.x() + dx_mm;
    const CameraTravel travel = camera_travel(pilot.rig);
    if (target_s_mm < travel.low_mm || target_s_mm > travel.high_mm)
        return failure(Reason::out_of_reach, fmt::format("{:.3f} mm is out of travel", target_s_mm));
    if (auto driven = impl_->drive_or_search(target_s_mm, tag_id); !driven) return forward(driven.error());
    const control::PositionerState& state = pilot.state;
    Arrival arrival;
    arrival.tag_id = tag_id;
    arrival.target_dx_um = um_from_mm(dx_mm);
    arrival.reached_dx_um = um_from_mm(dx_mm - state.reached.needed_mm);
    arrival.reached_std_um =
        um_from_mm(std::hypot(state.reached.std_mm, calibration_std_mm(*pilot.rig.camera, dx_mm)));
    arrival.reached_dy_um = um_from_mm(pilot.camera_mm.y() - tag->centre_mm.y());
    arrival.macro_time_s = state.macro_s;
    arrival.micro_time_s = state.micro_s;
    arrival.micro_moves = state.moves;
    arrival.within_tolerance = std::abs(state.reached.needed_mm) <= pilot.params.tolerance_mm;
    return arrival;
}

bool Session::camera_is_in_doubt() const {
    return impl_->pilot.machine.camera_is_in_doubt();
}

Status Session::check_rig() {
    return fidservo::check_rig(impl_->pilot);
}

Result<vision::Frame> Session::capture() {
    Pilot& pilot = impl_->pilot;
    const auto count = pilot.state.macro.last_count;
    const double platform_mm = pilot.state.micro.average_mm;
    auto frame = pilot.next_frame(pilot.machine.now_ns());
    if (!frame) return frame;
    if (pilot.state.macro.last_count != count ||
        std::abs(pilot.state.micro.average_mm - platform_mm) > still_mm)
        return failure(Reason::not_at_rest, "the stage moved while the picture was taken");
    if (const auto fit = pilot.sight.locate(*frame, pilot.believed_s_mm())) pilot.saw(fit->position);
    if (auto kept = pilot.keep_sight(*frame); !kept) return forward(kept.error());
    return frame;
}

Status Session::hold(double duration_s) {
    for (auto ticks = std::lround(duration_s / impl_->pilot.rig.tick_s); ticks > 0; --ticks)
        if (auto stepped = impl_->pilot.step(); !stepped) return stepped;
    return {};
}

Status Session::observe(double duration_s) {
    for (auto ticks = std::lround(duration_s / impl_->pilot.rig.tick_s); ticks > 0; --ticks) {
        if (auto stepped = impl_->pilot.step(); !stepped) return stepped;
        if (auto looked = look(); !looked) return looked;
    }
    return {};
}

Status Session::look() {
    Pilot& pilot = impl_->pilot;
    const auto frame = pilot.machine.poll_camera();
    if (!frame) return forward(frame.error());
    if (!*frame) return {};
    if (const auto fit = pilot.sight.locate_anywhere(**frame)) pilot.saw(fit->position);
    std::vector<TagDetection> tags;
    // As the picture shows them: what the rig file says of tilt and lens may be what is to be found out.
    const vision::RefinementOptions as_it_is{std::nullopt, vision::grey_noise(*pilot.rig.camera)};
    for (const TagDetection& tag : pilot.sight.found())
        if (const auto refined = vision::refine_tag((*frame)->image, tag, as_it_is))
            tags.push_back(refined->detection);
    if (auto kept = pilot.machine.keep(pilot.sight.found(), tags); !kept) return kept;
    return impl_->keep_frames == KeepFrames::yes ? pilot.machine.keep(**frame) : Status();
}

void Session::show_to(std::shared_ptr<LiveFeed> feed) {
    impl_->pilot.machine.show_to(std::move(feed));
}

void Session::stop_now() noexcept {
    if (impl_->guardian) impl_->guardian->stop();
    request_interrupt();
}

Status Session::wait_while(const std::function<bool()>& condition) {
    constexpr double nap_s = 0.01;
    while (condition()) {
        if (interrupt_requested()) return failure(Reason::stopped, "stopped by the user");
        if (impl_->simulated) {
            std::this_thread::sleep_for(std::chrono::duration<double>(nap_s));
        } else if (auto held = hold(nap_s); !held) {
            return held;
        }
    }
    return {};
}

Pilot& Session::pilot() {
    return impl_->pilot;
}

Eigen::Vector2d Session::camera_mm() const {
    return impl_->pilot.camera_mm;
}

vision::FrameCounts Session::frame_counts() const {
    return impl_->pilot.machine.frame_counts();
}

std::optional<control::LoopStatistics> Session::loop_statistics() const {
    return impl_->pilot.machine.loop_statistics();
}

double Session::now_s() const {
    return seconds(impl_->pilot.machine.now_ns());
}

double Session::elapsed_s() const {
    return seconds(impl_->pilot.machine.elapsed_ns());
}

namespace {

/// Under which a checkpoint has the setpoints that are in force.
constexpr std::array setpoint_names{std::pair{"macro_setpoint_mm", &Setpoints::macro_mm},
                                    std::pair{"micro_setpoint_mm", &Setpoints::micro_mm}};

}  // namespace

void Session::Impl::take_up(const nlohmann::json& json) {
    read_json(json.at("heater"), pilot.params.micro.model.heater);
    pilot.params.micro.model.stroke_scale = json.at("stroke_scale");
    json.at("hall_correction").get_to(pilot.params.micro.model.hall_correction);
    read_json(json.at("positioner"), pilot.state);
    pilot.count_zero_mm = json.at("count_zero_mm");
    pilot.registered = true;
    pilot.registered_by = "a tag, before the run was taken up again";
    pilot.camera_delay_s = json.at("camera_delay_s");
    pilot.camera_mm =
        Eigen::Vector2d(json.at("camera_mm").at(0).get<double>(), json.at("camera_mm").at(1).get<double>());
    for (const auto& [name, setpoint] : setpoint_names)
        pilot.setpoints.*setpoint = json.value(name, not_in_force);
    pilot.machine.set_now(json.at("now_ns"));
    if (simulated) simulated->restore(json.at("rig"));
}

std::string Session::checkpoint() const {
    const Pilot& pilot = impl_->pilot;
    nlohmann::json json{{"positioner", json_of(pilot.state)},
                        {"heater", json_of(pilot.params.micro.model.heater)},
                        {"stroke_scale", pilot.params.micro.model.stroke_scale},
                        {"hall_correction", pilot.params.micro.model.hall_correction},
                        {"count_zero_mm", pilot.count_zero_mm},
                        {"camera_delay_s", pilot.camera_delay_s},
                        {"camera_mm", {pilot.camera_mm.x(), pilot.camera_mm.y()}},
                        {"now_ns", pilot.machine.now_ns()}};
    for (const auto& [name, setpoint] : setpoint_names)
        if (!std::isnan(pilot.setpoints.*setpoint)) json[name] = pilot.setpoints.*setpoint;
    if (impl_->simulated) json["rig"] = impl_->simulated->snapshot();
    return json.dump();
}

void Session::restore(const std::string& checkpoint) {
    try {
        impl_->take_up(nlohmann::json::parse(checkpoint));
    } catch (const nlohmann::json::exception& problem) {
        throw InputError(fmt::format("the checkpoint is damaged: {}", problem.what()));
    }
}

}  // namespace fidservo
