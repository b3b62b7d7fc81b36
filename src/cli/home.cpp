// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo home: end stop, registration against a tag, tuning sweep.
#include "core/rig.h"
#include "src/cli/commands.h"
#include "src/cli/session_options.h"
#include "src/files/rig/rig_file.h"
#include "src/session/session.h"

#include <filesystem>
#include <memory>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

namespace fidservo {

namespace {

struct HomeOptions {
    SessionOptions session;
    std::filesystem::path out;  ///< of the recording; empty: none
};

int run_home(const HomeOptions& options) {
    const Rig rig = load_rig(options.session.rig_file);
    const Plate plate = rig_plate(rig, options.session.rig_file);
    Session session(options.session, rig, plate, plate);
    return recorded(session, options.out, "homing", [&]() -> int {
        if (const auto homed = session.home(); !homed) return end_of_run("home", homed.error());
        fmt::print("homed after {:.1f} s; camera at x {:.3f} mm, y {:.3f} mm\n", session.now_s(),
                   session.camera_mm().x(), session.camera_mm().y());
        return exit_done;
    });
}

}  // namespace

void add_home(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<HomeOptions>();
    CLI::App* command = app.add_subcommand("home",
                                           "Find the end stop, register against a fiducial, tune the micro "
                                           "stage (other commands do it when needed)");
    add_recording_option(*command, options->out);
    add_session_options(*command, options->session);
    add_sim_rig_option(*command, options->session);
    add_example(*command, "fidservo home --rig assets/rig.yaml");
    command->callback([options, &exit_code] { exit_code = run_home(*options); });
}

}  // namespace fidservo
