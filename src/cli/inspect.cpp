// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo inspect: a whole inspection, from a recipe to a report.
#include "core/input_error.h"
#include "src/cli/commands.h"
#include "src/cli/session_options.h"
#include "src/files/disk/output_paths.h"
#include "src/inspect/inspection_run.h"
#include "src/inspect/measure/output.h"

#include <memory>
#include <string>
#include <vector>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

namespace fidservo {

namespace {

constexpr int default_live_port = 8731;

int run_inspect(const inspect::InspectionOptions& options) {
    const inspect::Counts counts = inspect::run_inspection(options);
    fmt::print("{} checks: {} passed, {} failed, {} not decidable, {} not measured\n", counts.total(),
               counts.pass, counts.fail, counts.not_decidable, counts.not_measured);
    fmt::print("report: {}\n", (options.out / "report.html").string());
    return counts.pass == counts.total() ? exit_done : exit_answer_is_no;
}

}  // namespace

void add_inspect(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<inspect::InspectionOptions>();
    CLI::App* command = app.add_subcommand(
        "inspect", "Inspect a plate as a recipe says; exit code 1 if anything fails or cannot be decided");
    command->add_option("recipe", options->recipe, "What to inspect (docs/inspection.md)")
        ->required()
        ->type_name("RECIPE.yaml");
    add_session_options(*command, options->session);
    add_sim_rig_option(*command, options->session);
    add_origin_options(*command, options->session.origin);
    options->session.recordings_state_time = true;
    command->get_option("--camera")
        ->description(
            "Camera: sim, v4l2:/dev/video0 (fidservo cameras lists them), or images:DIR to measure "
            "the images of an earlier run again");
    command->add_option("--out", options->out, "New folder for results, report, images and recordings")
        ->required();
    options->diagnosis = true;
    command->add_flag("!--no-diagnosis", options->diagnosis,
                      "Leave out what the run's own recordings say of the rig");
    command
        ->add_option(
            "--history", options->history,
            "File of the rig's history: what the run's own recordings say is appended, and a rig that "
            "has changed is warned of")
        ->type_name("FILE");
    command->add_flag("--resume", options->resume,
                      "Go on with a run that was interrupted, in the same folder");
    command
        ->add_option_function<std::vector<std::string>>(
            "--live",
            [options](const std::vector<std::string>& port) {
                const bool given = !port.empty() && !port.front().empty();
                options->live_port = given ? std::stoi(port.front()) : default_live_port;
            },
            fmt::format("A page that shows the run and can pause and stop it, at this port of 127.0.0.1 ({})",
                        default_live_port))
        ->expected(0, 1)
        ->check(
            [](const std::string& port) { return port.empty() ? std::string() : CLI::Range(0, 65535)(port); })
        ->type_name("[PORT]");
    command
        ->add_option_function<std::vector<std::string>>(
            "--fault",
            [options](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) options->session.faults.push_back(parse_fault(text));
            },
            "A drill: lets a device fail (docs/faults.md)")
        ->type_name("KIND[:from_s=S,for_s=S]");
    add_example(*command, "fidservo inspect assets/demo/recipe.yaml --out out/demo");
    command->callback([options, command, &exit_code] {
        if (command->count("--seed") > 0) options->seed = options->session.seed;
        if (!options->history.empty()) demand_appendable("--history", options->history);
        if (!options->history.empty() && !options->diagnosis)
            throw InputError("--history: is made of the run's diagnosis; leave --no-diagnosis out");
        exit_code = run_inspect(*options);
    });
}

}  // namespace fidservo
