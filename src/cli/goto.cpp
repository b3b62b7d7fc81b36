// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo goto: one fiducial-relative motion.
#include "core/failure.h"
#include "core/input_error.h"
#include "core/result.h"
#include "core/rig.h"
#include "core/units.h"
#include "src/cli/commands.h"
#include "src/cli/session_options.h"
#include "src/files/rig/plate_file.h"
#include "src/files/rig/rig_file.h"
#include "src/process/interrupt.h"
#include "src/session/motion_params.h"
#include "src/session/rig_check.h"
#include "src/session/session.h"
#include "vision/tags/tag_choice.h"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <thread>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fidservo {

namespace {

struct GotoOptions {
    SessionOptions session;
    int tag = 0;
    double dx_um = 0.0;
    std::optional<double> hold_s;
    std::filesystem::path out;  ///< of the recording; empty: none
};

/// To a tenth of a nanometre or a microsecond: more digits say nothing.
double rounded(double value, double steps_per_unit) {
    return std::round(value * steps_per_unit) / steps_per_unit;
}

/// What scripts read: one line on stdout.
void print_arrival(const Arrival& arrival) {
    constexpr double um = 1e4, s = 1e6;
    const nlohmann::ordered_json json{{"tag", arrival.tag_id},
                                      {"target_dx_um", arrival.target_dx_um},
                                      {"reached_dx_um", rounded(arrival.reached_dx_um, um)},
                                      {"uncertainty_um", rounded(arrival.reached_std_um, um)},
                                      {"dy_um", rounded(arrival.reached_dy_um, um)},
                                      {"within_tolerance", arrival.within_tolerance},
                                      {"macro_time_s", rounded(arrival.macro_time_s, s)},
                                      {"micro_time_s", rounded(arrival.micro_time_s, s)},
                                      {"micro_moves", arrival.micro_moves}};
    fmt::print("{}\n", json.dump());
    std::fflush(stdout);
}

/// Holds for a time of the rig's clock, or, paced by the wall clock, until the user interrupts.
void hold(Session& session, const std::optional<double>& hold_s) {
    constexpr double slice_s = 0.02;
    if (hold_s) {
        if (const auto held = session.hold(*hold_s); !held && held.error().reason != Reason::stopped)
            throw RunFault(held.error().text);
        return;
    }
    for (auto next = std::chrono::steady_clock::now(); !interrupt_requested();) {
        if (const auto held = session.hold(slice_s); !held && held.error().reason != Reason::stopped)
            throw RunFault(held.error().text);
        std::this_thread::sleep_until(next += std::chrono::duration_cast<std::chrono::nanoseconds>(
                                          std::chrono::duration<double>(slice_s)));
    }
}

void demand_finite(const char* option, double value) {
    if (!std::isfinite(value))
        throw InputError(fmt::format("{}: {}: must be a number that is finite", option, value));
}

/// Refuses, before anything moves, a target that the camera cannot be brought to.
void demand_reachable(const Rig& rig, const PlateTag& tag, const GotoOptions& options) {
    const CameraTravel travel = camera_travel(rig);
    const double low_um = um_from_mm(travel.low_mm - tag.centre_mm.x()),
                 high_um = um_from_mm(travel.high_mm - tag.centre_mm.x());
    if (options.dx_um < low_um || options.dx_um > high_um)
        throw InputError(
            fmt::format("--dx-um: {}: out of the stage's travel; allowed at tag {}: {:.0f} to {:.0f} um",
                        options.dx_um, tag.id, low_um, high_um));
}

int go_and_hold(Session& session, const GotoOptions& options) {
    if (const auto homed = session.home(); !homed) return end_of_run("homing", homed.error());
    const auto arrival = session.go_to(options.tag, mm_from_um(options.dx_um));
    if (!arrival && puts_rig_in_doubt(arrival.error().reason))
        if (const auto well = session.check_rig(); !well) return end_of_run("goto", well.error());
    if (!arrival) return end_of_run("goto", arrival.error());
    print_arrival(*arrival);
    hold(session, options.hold_s);
    return arrival->within_tolerance ? exit_done : exit_answer_is_no;
}

int run_goto(const GotoOptions& options) {
    demand_finite("--dx-um", options.dx_um);
    demand_finite("--hold", options.hold_s.value_or(0.0));
    const Rig rig = load_rig(options.session.rig_file);
    const Plate plate = rig_plate(rig, options.session.rig_file);
    const auto tag = vision::find_tag(plate, options.tag);
    if (!tag)
        throw InputError(fmt::format("--tag {}: not on the plate of {}; allowed: {} to {}", options.tag,
                                     options.session.rig_file.string(), plate.tags.front().id,
                                     plate.tags.back().id));
    demand_reachable(rig, *tag, options);
    Session session(options.session, rig, plate, plate);
    return recorded(session, options.out, "goto", [&] { return go_and_hold(session, options); });
}

}  // namespace

void add_goto(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<GotoOptions>();
    CLI::App* command = app.add_subcommand("goto",
                                           "Bring the camera to a fiducial, or beside it; prints one JSON "
                                           "line on arrival and holds until Ctrl-C");
    command->add_option("--tag", options->tag, "Id of the fiducial")->required();
    command->add_option("--dx-um", options->dx_um, "Offset from its centre along the stage axis, um");
    command->add_option("--hold", options->hold_s, "Hold for so many seconds, then switch the heater off")
        ->check(CLI::NonNegativeNumber);
    add_recording_option(*command, options->out);
    add_session_options(*command, options->session);
    add_sim_rig_option(*command, options->session);
    add_example(*command, "fidservo goto --tag 12 --dx-um 150 --hold 5");
    command->callback([options, &exit_code] { exit_code = run_goto(*options); });
}

}  // namespace fidservo
