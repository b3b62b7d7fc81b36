// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/session_options.h"

#include "core/failure.h"
#include "core/input_error.h"
#include "core/rig.h"
#include "src/cli/commands.h"
#include "src/files/disk/output_paths.h"
#include "src/files/rig/plate_file.h"

#include <cstdio>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

namespace fidservo {

namespace {

void add_label(const std::string& text, RecordingOrigin& origin) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
        throw InputError(fmt::format("--label: {}: must be KEY=VALUE", text));
    if (!origin.labels.emplace(text.substr(0, equals), text.substr(equals + 1)).second)
        throw InputError(
            fmt::format("--label: {}: the label {} was given already", text, text.substr(0, equals)));
}

}  // namespace

void add_session_options(CLI::App& command, SessionOptions& options) {
    add_rig_option(command, options.rig_file);
    command.add_option("--stage", options.stage, "Stage: sim or comedi:/dev/comedi0")
        ->type_name("STAGE")
        ->capture_default_str();
    command
        .add_option("--camera", options.camera,
                    "Camera: sim or v4l2:/dev/video0 (fidservo cameras lists them)")
        ->type_name("CAMERA")
        ->capture_default_str();
    command.add_option("--seed", options.seed, "Seed of the simulated rig's noise")->capture_default_str();
}

void add_sim_rig_option(CLI::App& command, SessionOptions& options) {
    command
        .add_option(
            "--sim-rig", options.sim_rig_file,
            "The rig that is simulated, where it is not what --rig says; the program does not look at it")
        ->type_name("RIG.yaml");
}

void add_origin_options(CLI::App& command, RecordingOrigin& origin) {
    command.add_option("--unit", origin.unit, "Which of several rigs of a kind it is; recordings say so")
        ->type_name("NAME")
        ->check([](const std::string& name) { return name.empty() ? "a name is needed" : ""; });
    command
        .add_option_function<std::vector<std::string>>(
            "--label",
            [&origin](const std::vector<std::string>& labels) {
                for (const std::string& label : labels) add_label(label, origin);
            },
            "Whatever else recordings are told apart by, e.g. batch=7; may be repeated")
        ->type_name("KEY=VALUE")
        ->expected(1)
        ->take_all();
}

void add_recording_option(CLI::App& command, std::filesystem::path& out) {
    command
        .add_option("--out", out,
                    "New folder for a recording of all that happens; fidservo diagnose DIR judges it")
        ->type_name("DIR");
}

int recorded(Session& session, const std::filesystem::path& out, const std::string& experiment,
             const std::function<int()>& work) {
    if (out.empty()) return work();
    demand_new_folder(out);
    session.record_to(out, experiment);
    try {
        const int exit_code = work();
        if (const auto closed = session.end_recording(); !closed) throw RunFault(closed.error().text);
        return exit_code;
    } catch (const RunFault&) {
        session.leave_recording();
        throw;
    }
}

int end_of_run(std::string_view what, const Failure& why) {
    const std::string line = fmt::format("{}: {}: {}", what, name_of(why.reason), why.text);
    if (why.reason == Reason::device || why.reason == Reason::stopped || why.reason == Reason::timeout)
        throw RunFault(line);
    fmt::print(stderr, "fidservo: {}\n", line);
    return exit_answer_is_no;
}

}  // namespace fidservo
