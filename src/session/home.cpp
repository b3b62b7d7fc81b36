// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/home.h"

#include "core/failure.h"
#include "core/rig.h"
#include "src/session/motion_params.h"
#include "src/session/rig_check.h"
#include "src/session/tuning_sweep.h"
#include "vision/tags/tag_choice.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace fidservo {

namespace {

constexpr double registration_lead_mm =
    1.7;                                ///< of the tag before the axis, so that the sweep keeps it in view
constexpr double most_astray_mm = 5.0;  ///< by which a plate may lie off where the rig file has it

Status seek_end_stop(Pilot& pilot) {
    const control::HomingParams homing = homing_params(pilot.rig);
    control::HomingState seeking;
    const auto command = [&](const control::StageSample& sample) -> control::StageCommand {
        return {control::homing_update(homing, seeking, sample.encoder_count), 0.0};
    };
    const auto ended = [&] {
        if (seeking.phase == control::HomingPhase::seeking) return false;
        return seeking.phase == control::HomingPhase::failed ||
               control::macro_is_quiet(homing.macro, seeking.macro);
    };
    if (auto sought = pilot.machine.run(command, ended); !sought) return sought;
    if (seeking.phase == control::HomingPhase::failed)
        return failure(Reason::no_convergence, "homing: the end stop was not found over the whole travel");
    pilot.register_at_end_stop(seeking.stop_count);
    pilot.machine.note("end_stop", fmt::format("at count {}", seeking.stop_count));
    return {};
}

/// The carriage also stands where something else than the end stop holds it, perhaps for good.
/// @param astray_mm  how far it is from where it should be
Status demand_carriage(Pilot& pilot, double astray_mm) {
    if (auto answers = check_carriage(pilot); !answers) return answers;
    spdlog::warn(
        "the carriage stopped {:.1f} mm from where the rig file has its end stop: is something in its way, "
        "or "
        "does the plate lie elsewhere?",
        astray_mm);
    return {};
}

/// The end stop is good to a count; a tag's id and place fix the absolute position.
Status register_by_tag(Pilot& pilot) {
    const std::vector<PlateTag> tags = registration_tags(pilot.rig, pilot.nominal);
    if (tags.empty())
        return failure(Reason::out_of_reach, "homing: no fiducial of the plate can be brought into view");
    const auto nearest = std::ranges::min_element(
        tags, {}, [&](const PlateTag& tag) { return std::abs(tag.centre_mm.x() - pilot.believed_s_mm()); });
    Failure why{Reason::no_tag, ""};
    for (const double offset_mm : search_offsets_mm) {
        if (auto carried = pilot.carry_to(nearest->centre_mm.x() - registration_lead_mm + offset_mm);
            !carried) {
            if (carried.error().reason == Reason::timeout)
                if (auto answers = check_carriage(pilot); !answers) return answers;
            return carried;
        }
        const auto fit = pilot.look_anywhere();
        if (fit) {
            const double astray_mm = fit->position.s_mm - pilot.believed_s_mm();
            pilot.register_at(fit->position.s_mm, fit->position.tag_id);
            pilot.saw(fit->position);
            return std::abs(astray_mm) < most_astray_mm ? Status() : demand_carriage(pilot, astray_mm);
        }
        why = fit.error();
    }
    if (pilot.machine.camera_is_in_doubt())
        if (auto well = check_camera(pilot); !well) return well;
    return failure(why.reason, fmt::format("homing: tag {} not found near {:.1f} mm: {}", nearest->id,
                                           nearest->centre_mm.x(), why.text));
}

/// What the camera sees of the sweep while it goes on.
Status watch_sweep(Pilot& pilot, std::vector<calib::CameraSight>& sights) {
    const auto frame = pilot.machine.poll_camera();
    if (!frame) return forward(frame.error());
    if (!*frame) return {};
    const auto fit = pilot.sight.locate_anywhere(**frame);
    if (fit) sights.push_back({(*frame)->time_ns, fit->position.s_mm, fit->position.s_std_mm});
    return pilot.keep_sight(**frame);
}

Result<SweepRecord> sweep(Pilot& pilot) {
    SweepRecord record;
    SweepProfile profile(pilot.params.micro.model);
    const TimeNs tick_ns = nanoseconds(pilot.rig.tick_s);
    record.hall.tick_ns = tick_ns;
    record.hall.adc.reserve(SweepProfile::most_ticks);
    record.command_V.reserve(SweepProfile::most_ticks);
    bool over = false;
    const auto command = [&](const control::StageSample& sample) -> control::StageCommand {
        if (record.command_V.empty()) record.hall.start_ns = sample.time_ns;
        // Ticks that a late loop left out: the command went on, and so did the platform.
        const auto due = (sample.time_ns - record.hall.start_ns + tick_ns / 2) / tick_ns;
        while (!record.hall.adc.empty() && static_cast<TimeNs>(record.hall.adc.size()) < due &&
               record.hall.adc.size() < SweepProfile::most_ticks) {
            record.hall.adc.push_back(record.hall.adc.back());
            record.command_V.push_back(record.command_V.back());
        }
        const auto command_V = profile.next(sample.hall_adc);
        over = !command_V.has_value();
        record.hall.adc.push_back(sample.hall_adc);
        record.command_V.push_back(command_V.value_or(pilot.params.micro.model.heater.onset_V));
        pilot.state.micro.position_mm = pilot.state.micro.average_mm =
            platform_position_mm(pilot.params.micro.model, sample.hall_adc);
        return {0.0, record.command_V.back()};
    };
    auto swept = pilot.machine.run(
        command, [&] { return over; }, {}, [&] { return watch_sweep(pilot, record.sights); });
    if (!swept) return forward(swept.error());
    return record;
}

/// A sweep in which the Hall sensor saw nothing move shows a fault, not a rig.
Status demand_answer(const Pilot& pilot, const SweepRecord& record) {
    constexpr double least_share = 0.2;  // of the stroke; the sweep is to go over 88 %
    const auto [low, high] = std::ranges::minmax(
        record.hall.adc, {}, [&](double adc) { return platform_position_mm(pilot.params.micro.model, adc); });
    const double hall_mm = std::abs(platform_position_mm(pilot.params.micro.model, high) -
                                    platform_position_mm(pilot.params.micro.model, low));
    if (hall_mm >= least_share * pilot.params.micro.model.fod->stroke_mm()) return {};
    double camera_mm = NAN;
    if (!record.sights.empty()) {
        const auto [from, to] = std::ranges::minmax(record.sights, {}, &calib::CameraSight::s_mm);
        camera_mm = to.s_mm - from.s_mm;
    }
    return tl::make_unexpected(unmoved_platform(hall_mm, camera_mm));
}

Status tune_by_sweep(Pilot& pilot) {
    const auto record = sweep(pilot);
    if (!record) return forward(record.error());
    if (auto answered = demand_answer(pilot, *record); !answered) return answered;
    const auto tuning =
        tune(pilot.params.micro.model, *record, pilot.rig.tick_s, pilot.rig.camera->exposure_s);
    if (tuning) {
        pilot.params.micro.model = tuning->model;
        pilot.camera_delay_s = tuning->camera_delay_s;
    } else {
        spdlog::warn("the rig file's numbers are used for the micro stage: {}", tuning.error().text);
    }
    const auto count = pilot.state.macro.last_count;
    pilot.state = control::positioner_start(pilot.params);
    pilot.state.macro.last_count = count;
    pilot.state.micro.wire = wire_after(pilot.params.micro.model, record->command_V, pilot.rig.tick_s);
    pilot.state.micro.average_mm = platform_position_mm(pilot.params.micro.model, record->hall.adc.back());
    if (auto caught = pilot.catch_up(); !caught) return caught;
    control::micro_begin_move(pilot.params.micro, pilot.state.micro,
                              0.5 * (pilot.params.park_low_mm + pilot.params.park_high_mm));
    return pilot.step_until([&] { return pilot.state.micro.phase != control::MicroPhase::approach; },
                            pilot.params.micro.shaping.timeout_s + 1.0,
                            "the micro stage did not reach the middle of its travel");
}

/// Where the carriage is, and how the micro stage answers.
Status find_out(Pilot& pilot) {
    if (auto done = seek_end_stop(pilot); !done) return done;
    if (auto done = register_by_tag(pilot); !done) return done;
    pilot.machine.note("registered", pilot.registered_by);
    pilot.machine.set_travel(pilot.carriage_travel());
    return tune_by_sweep(pilot);
}

}  // namespace

std::vector<PlateTag> registration_tags(const Rig& rig, const Plate& plate) {
    std::vector<PlateTag> tags = vision::reachable_rows(rig.camera.value().geometry, plate);
    std::erase_if(tags, [&](const PlateTag& tag) {
        return tag.centre_mm.x() < rig.macro.low_mm + registration_lead_mm ||
               tag.centre_mm.x() > rig.macro.high_mm + registration_lead_mm;
    });
    return tags;
}

Status home(Pilot& pilot) {
    pilot.machine.note("homing", "begun");
    Status homed = find_out(pilot);
    pilot.machine.note("homing", homed ? "ended" : homed.error().text);
    return homed;
}

}  // namespace fidservo
