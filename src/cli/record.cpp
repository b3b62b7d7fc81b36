// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo record: what the rig does when nobody moves it, or the experiments of `simulate` on it.
#include "core/failure.h"
#include "core/input_error.h"
#include "core/result.h"
#include "core/rig.h"
#include "src/cli/commands.h"
#include "src/cli/session_options.h"
#include "src/files/disk/output_paths.h"
#include "src/files/rig/plate_file.h"
#include "src/files/rig/rig_file.h"
#include "src/record/record_experiments.h"
#include "src/session/camera_choice.h"
#include "src/session/session.h"

#include <memory>
#include <optional>
#include <string>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

struct RecordOptions {
    ExperimentOptions what;  ///< without an experiment: at rest
    std::optional<double> duration_s;
};

void check(const Status& status) {
    if (!status) throw RunFault(status.error().text);
}

int record_rest(const RecordOptions& options) {
    constexpr double usual_s = 4.0;
    const SessionOptions& devices = options.what.session;
    if (options.what.resume)
        throw InputError("--resume: a recording at rest is made anew; it is for EXPERIMENT and campaign");
    const Rig rig = load_rig(devices.rig_file);
    const Plate plate = rig_plate(rig, devices.rig_file);
    demand_new_folder(options.what.out);
    Session session(devices, rig, plate, plate);
    session.record_to(options.what.out, "rest", options.what.frames ? KeepFrames::yes : KeepFrames::no);
    const Status held = session.observe(options.duration_s.value_or(usual_s));
    if (!held && held.error().reason != Reason::stopped) {
        session.leave_recording();
        throw RunFault(held.error().text);
    }
    check(session.end_recording());
    fmt::print("{:.3f} s recorded in {}\n", session.elapsed_s(), options.what.out.string());
    if (!camera_is_simulated(devices)) fmt::print("{}\n", text_of(session.frame_counts()));
    return exit_done;
}

int run_record(const RecordOptions& options) {
    if (options.what.experiment.empty()) return record_rest(options);
    if (options.duration_s)
        throw InputError(fmt::format("--duration {}: is for a recording at rest; {} has its own",
                                     *options.duration_s, options.what.experiment));
    return record_experiments(options.what) ? exit_done : exit_answer_is_no;
}

}  // namespace

void add_record(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<RecordOptions>();
    ExperimentOptions& what = options->what;
    CLI::App* command = app.add_subcommand(
        "record", "Record experiments on the rig, or the rig at rest: sensors, commands, fiducials");
    command
        ->add_option("EXPERIMENT", what.experiment,
                     fmt::format("{}; campaign: two of each that the rig can do; or FILE.yaml, an experiment "
                                 "of one's own (docs/formats.md). Without it: at rest, not homed",
                                 fmt::join(experiment_kinds(), ", ")))
        ->option_text(" ");
    command
        ->add_option("--duration", options->duration_s,
                     "Of a recording at rest, s [4]; Ctrl-C ends it earlier")
        ->check(CLI::PositiveNumber);
    command->add_option("--out", what.out, "New folder for the recording, or the campaign's recordings")
        ->type_name("DIR")
        ->required();
    command->add_flag("--resume", what.resume,
                      "Go on with an interrupted run: record what is missing in DIR");
    command->add_flag("--frames", what.frames, "Keep the camera's images too");
    add_session_options(*command, what.session);
    command->get_option("--seed")->description(
        "Determines the excitation, as in simulate, and the simulated rig's noise");
    add_sim_rig_option(*command, what.session);
    add_origin_options(*command, what.session.origin);
    what.session.recordings_state_time = true;
    add_example(
        *command,
        "fidservo record campaign --stage comedi:/dev/comedi0 --camera v4l2:/dev/video0 --out monday");
    command->callback([options, &exit_code] { exit_code = run_record(*options); });
}

}  // namespace fidservo
