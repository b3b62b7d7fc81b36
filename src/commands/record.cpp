// fidservo record: what the rig does when nobody moves it.
#include "core/failure.h"
#include "core/input_error.h"
#include "core/result.h"
#include "core/rig.h"
#include "src/commands/commands.h"
#include "src/commands/session_options.h"
#include "src/config/rig_file.h"
#include "src/session/camera_choice.h"
#include "src/session/session.h"

#include <memory>
#include <string>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>

namespace fidservo {

namespace {

struct RecordOptions {
    SessionOptions session;
    std::filesystem::path out;
    double duration_s = 4.0;
    bool frames = false;
};

void check(const Status& status) {
    if (!status) throw RunFault(status.error().text);
}

int run_record(const RecordOptions& options) {
    const Rig rig = load_rig(options.session.rig_file);
    const Plate plate = rig_plate(rig, options.session.rig_file);
    Session session(options.session, rig, plate, plate);
    session.record_to(options.out, "rest", options.frames ? KeepFrames::yes : KeepFrames::no);
    const Status held = session.observe(options.duration_s);
    check(session.end_recording());
    if (!held && held.error().reason != Reason::stopped) throw RunFault(held.error().text);
    fmt::print("{:.3f} s recorded in {}\n", session.elapsed_s(), options.out.string());
    if (!camera_is_simulated(options.session)) fmt::print("{}\n", text_of(session.frame_counts()));
    return exit_done;
}

}  // namespace

void add_record(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<RecordOptions>();
    CLI::App* command = app.add_subcommand("record", "Record the rig at rest: sensors, commands, fiducials");
    command->add_option("--duration", options->duration_s, "How long, s; Ctrl-C ends it earlier")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--out", options->out, "New folder for the recording")->type_name("DIR")->required();
    command->add_flag("--frames", options->frames, "Keep the camera's images too");
    add_session_options(*command, options->session);
    add_sim_rig_option(*command, options->session);
    add_example(*command, "fidservo record --duration 10 --out rest-10s");
    command->callback([options, &exit_code] { exit_code = run_record(*options); });
}

}  // namespace fidservo
