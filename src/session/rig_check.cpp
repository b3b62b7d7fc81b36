// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/rig_check.h"

#include "core/rig.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace fidservo {

namespace {

constexpr double carriage_way_mm = 2.0, carriage_limit_s = 2.0;
constexpr double platform_way_mm = 0.6, platform_limit_s = 4.0;
constexpr double heating_degC = 60.0, blind_s = 1.2;
constexpr double share = 0.5;  ///< of the way: enough of an answer

/// The camera's place if a tag is in view; empty if not.
Result<std::optional<double>> seen_s_mm(Pilot& pilot) {
    const auto fit = pilot.look_anywhere();
    if (fit) return fit->position.s_mm;
    if (ends_the_run(fit.error().reason)) return forward(fit.error());
    return std::nullopt;
}

/// Heats and cools without asking the Hall sensor: one of the two moves a platform that can move.
Status find_the_fault(Pilot& pilot, double start_mm, const std::optional<double>& start_s_mm) {
    const HeaterParameters& heater = pilot.params.micro.model.heater;
    double hall_mm = 0.0, camera_mm = start_s_mm ? 0.0 : NAN;
    for (const double rise_degC : {heating_degC, 0.0}) {
        const double command_V = rise_degC > 0.0 ? heater.onset_V + rise_degC / heater.gain_degC_per_V : 0.0;
        if (auto caught = pilot.catch_up(); !caught) return caught;
        control::micro_open_loop(pilot.state.micro, command_V);
        for (auto ticks = std::lround(blind_s / pilot.rig.tick_s); ticks > 0; --ticks)
            if (auto stepped = pilot.step(); !stepped) return stepped;
        const auto s_mm = seen_s_mm(pilot);
        if (!s_mm) return forward(s_mm.error());
        if (!*s_mm || !start_s_mm || std::abs(**s_mm - *start_s_mm) < std::abs(camera_mm)) continue;
        camera_mm = **s_mm - *start_s_mm;
        hall_mm = pilot.state.micro.average_mm - start_mm;
    }
    control::micro_switch_off(pilot.state.micro);
    return tl::make_unexpected(unmoved_platform(hall_mm, camera_mm));
}

Status check_platform(Pilot& pilot) {
    const auto before = seen_s_mm(pilot);
    if (!before) return forward(before.error());
    if (auto caught = pilot.catch_up(); !caught) return caught;
    const double start_mm = pilot.state.micro.average_mm;
    const double middle_mm = 0.5 * (pilot.params.park_low_mm + pilot.params.park_high_mm);
    const double way_mm = start_mm < middle_mm ? platform_way_mm : -platform_way_mm;
    const auto gone_mm = [&] { return pilot.state.micro.average_mm - start_mm; };
    control::micro_begin_move(pilot.params.micro, pilot.state.micro, start_mm + way_mm);
    const auto answered = pilot.step_until([&] { return gone_mm() / way_mm >= share; }, platform_limit_s, "");
    if (!answered && answered.error().reason == Reason::timeout)
        return find_the_fault(pilot, start_mm, *before);
    return answered;
}

}  // namespace

Status check_camera(Pilot& pilot) {
    // The machine's watch ends a silence that lasts too long.
    for (bool seen = false; !seen || pilot.machine.camera_is_in_doubt();) {
        const auto frame = pilot.next_frame(pilot.machine.now_ns());
        seen = frame.has_value();
        if (!seen && frame.error().reason != Reason::timeout) return forward(frame.error());
    }
    return {};
}

Status check_carriage(Pilot& pilot) {
    if (auto caught = pilot.catch_up(); !caught) return caught;
    const auto start_count = static_cast<double>(pilot.state.macro.last_count.value_or(0));
    const double start_mm = pilot.count_zero_mm + start_count * pilot.params.count_mm;
    const double middle_mm = 0.5 * (pilot.rig.macro.low_mm + pilot.rig.macro.high_mm);
    const double way_mm = start_mm < middle_mm ? carriage_way_mm : -carriage_way_mm;
    const auto gone_mm = [&] {
        return (static_cast<double>(*pilot.state.macro.last_count) - start_count) * pilot.params.count_mm;
    };
    control::macro_go_to(pilot.state.macro, start_count + way_mm / pilot.params.count_mm);
    const auto answered = pilot.step_until([&] { return gone_mm() / way_mm >= share; }, carriage_limit_s, "");
    pilot.state.macro.setpoint_count.reset();
    if (!answered && answered.error().reason == Reason::timeout)
        return failure(Reason::device,
                       fmt::format("the macro stage does not answer: told to go {:.1f} mm, the encoder shows "
                                   "{:.2f} mm: jammed, motor, supply or encoder?",
                                   way_mm, gone_mm()));
    if (!answered) return answered;
    return pilot.step_until([&] { return control::macro_is_quiet(pilot.params.macro, pilot.state.macro); },
                            carriage_limit_s, "the macro stage does not come to rest");
}

Failure unmoved_platform(double hall_mm, double camera_mm) {
    constexpr double agreement_mm = 0.2;
    std::string text =
        fmt::format("the micro stage does not answer: by the Hall sensor it went {:.3f} mm", hall_mm);
    if (std::isnan(camera_mm))
        text += ": heater, wire or Hall sensor?";
    else if (std::abs(camera_mm - hall_mm) > agreement_mm)
        text += fmt::format(", by the camera {:.3f} mm: Hall sensor?", camera_mm);
    else
        text += fmt::format(", by the camera {:.3f} mm: heater or wire?", camera_mm);
    return {Reason::device, text};
}

Status check_rig(Pilot& pilot) {
    pilot.state.phase = control::PositionerPhase::idle;
    if (auto well = check_camera(pilot); !well) return well;
    if (auto well = check_carriage(pilot); !well) return well;
    if (auto well = check_platform(pilot); !well) return well;
    const auto fit = pilot.look_anywhere();
    if (fit) pilot.register_at(fit->position.s_mm, fit->position.tag_id);
    if (!fit && ends_the_run(fit.error().reason)) return forward(fit.error());
    return {};
}

}  // namespace fidservo
