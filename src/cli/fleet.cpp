// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo fleet: many campaigns, or very many images, by tasks that do not know of each other.
#include "core/input_error.h"
#include "core/rig.h"
#include "src/cli/commands.h"
#include "src/cli/tag_options.h"
#include "src/files/rig/rig_file.h"
#include "src/fleet/diagnose.h"
#include "src/fleet/replay.h"
#include "src/fleet/stretch.h"

#include <memory>
#include <string>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>

namespace fidservo {
namespace {

/// --out, --shard, --resume, --jobs, --memory-mb.
void add_run_options(CLI::App& command, fleet::RunOptions& run) {
    command.add_option("--out", run.out, "Folder for the results; what is done there is not done again")
        ->type_name("FLEET")
        ->required();
    command
        .add_option_function<std::string>(
            "--shard", [&run](const std::string& text) { run.shard = fleet::parse_shard(text); },
            "The K-th of N shares of the tasks only")
        ->type_name("K/N");
    command.add_flag("--resume", run.resume,
                     "Go on with results that are there; with a folder that has none it is an error");
    command.add_option("--jobs", run.jobs, "Tasks at a time, of a core each; as many as cores if not given")
        ->type_name("N")
        ->check(CLI::Range(1, 4096));
    command.add_option("--memory-mb", run.memory_mb, "Of data that a task may have at most")
        ->type_name("MB")
        ->check(CLI::Range(100, 10'000'000))
        ->capture_default_str();
}

void add_fleet_diagnose(CLI::App& parent, int& exit_code) {
    auto request = std::make_shared<fleet::DiagnoseRequest>();
    CLI::App* command = parent.add_subcommand("diagnose",
                                              "Diagnose many campaigns, each by itself; exit code 1 if some "
                                              "could not be, 3 if some have no result");
    command
        ->add_option("CAMPAIGN", request->campaigns, "Folders of the recordings of one rig, at one time each")
        ->required()
        ->option_text("...");
    add_rig_option(*command, request->rig_file);
    const auto add_list = [&](const char* name, std::vector<std::string>& list, const char* text) {
        return command->add_option(name, list, text)->delimiter(',')->allow_extra_args(false);
    };
    add_list("--effects", request->asked.only, "Try these effects only")->type_name("A,B,..");
    add_list("--without", request->asked.without, "Leave these effects out, and those no data tell from them")
        ->type_name("A,B,..");
    command
        ->add_option("--effects-file", request->asked.effects_file,
                     "Effects as formulas (docs/effects.md) that are tried beside the listed ones")
        ->type_name("FILE");
    add_list("--matters", request->asked.matters,
             "What may stay unexplained of a signal without being called a gap: encoder=20um,tag=0.1px")
        ->type_name("SIGNAL=VALUE,..");
    command
        ->add_option("--effort", request->effort_s,
                     "What a diagnosis may search, in seconds that are counted by what it predicts: the same "
                     "on any machine")
        ->type_name("S")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    add_run_options(*command, request->run);
    add_example(*command,
                "fidservo fleet diagnose --rig assets/rig.yaml recordings/*/* --out fleet\n"
                "  fidservo fleet diagnose --rig assets/rig.yaml recordings/*/* --out fleet --shard 3/16");
    command->callback([request, &exit_code] { exit_code = fleet::diagnose_fleet(*request); });
}

struct FleetReplayOptions {
    fleet::ReplayRequest request;
    TagOptions tags;
};

int run_fleet_replay(FleetReplayOptions& options) {
    fleet::ReplayRequest& request = options.request;
    const Rig rig = load_rig(request.rig_file);
    request.name_times = name_times_of(options.tags);
    demand_fiducials(rig, request.rig_file);
    request.reading = reading_of(options.tags, request.rig_is_given ? rig.fiducials->print : TagPrint{});
    return fleet::replay_fleet(request, rig);
}

void add_fleet_replay(CLI::App& parent, int& exit_code) {
    auto options = std::make_shared<FleetReplayOptions>();
    fleet::ReplayRequest& request = options->request;
    CLI::App* command = parent.add_subcommand(
        "replay",
        fmt::format("Find the fiducials in very many images, {} at a time; writes what replay writes",
                    fleet::images_a_stretch));
    command
        ->add_option("INPUT", request.inputs,
                     "Recording folders (EuRoC layout), image folders, videos, images, stacks (TIFF)")
        ->required()
        ->option_text("...");
    add_rig_option(*command, request.rig_file);
    add_tag_options(*command, options->tags);
    add_run_options(*command, request.run);
    add_example(*command,
                "fidservo fleet replay photos/ --out photos-tags\n"
                "  fidservo fleet replay photos/ --out photos-tags --shard 3/16");
    command->callback([options, command, &exit_code] {
        options->request.rig_is_given = command->count("--rig") > 0;
        exit_code = run_fleet_replay(*options);
    });
}

}  // namespace

void add_fleet(CLI::App& app, int& exit_code) {
    CLI::App* group =
        app.add_subcommand("fleet", "Many campaigns of many units, on all cores or many machines");
    group->require_subcommand(0, 1);
    add_fleet_diagnose(*group, exit_code);
    add_fleet_replay(*group, exit_code);
    add_fleet_report(*group, exit_code);
    group->callback([group] {
        if (group->get_subcommands().empty())
            throw InputError("fleet: what? One of: diagnose, replay, report");
    });
}

}  // namespace fidservo
