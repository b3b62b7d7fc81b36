// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo replay: the analysis of a run on images that exist already.
#include "src/replay/replay.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "src/cli/commands.h"
#include "src/cli/tag_options.h"
#include "src/files/rig/rig_file.h"
#include "src/replay/unread_tags.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace fidservo {

namespace {

struct ReplayOptions {
    std::vector<std::filesystem::path> inputs;
    std::filesystem::path rig_file;
    bool rig_is_given = false;
    std::filesystem::path out = "replay-out";
    TagOptions tags;
};

void print_notes(const std::vector<std::string>& notes) {
    for (const std::string& note : notes) spdlog::info("{}", note);
}

int run_replay(const ReplayOptions& options) {
    const Rig rig = load_rig(options.rig_file);
    demand_fiducials(rig, options.rig_file);
    const vision::TagReading reading =
        reading_of(options.tags, options.rig_is_given ? rig.fiducials->print : TagPrint{});
    ImageFrames frames(options.inputs, {.name_times = name_times_of(options.tags)});
    print_notes(frames.notes());
    make_output_folder(options.out);
    const ReplayCount count =
        replay(frames, rig.fiducials->side_mm, options.out, std::max(1u, std::thread::hardware_concurrency()),
               options.rig_is_given ? rig.camera : std::nullopt, reading);
    print_notes(count.images.notes());
    if (count.images.read() == 0) {
        std::filesystem::remove_all(options.out);  // its tables have no row
        throw InputError(count.images.all() == 1 ? count.images.first_reason()
                                                 : fmt::format("{}; the first: {}", count.images.text(),
                                                               count.images.first_reason()));
    }
    fmt::print("{} tags in {}: {}, {}\n", count.tags, count.images.text(),
               (options.out / "detections.csv").string(), (options.out / "displacements.csv").string());
    for (const std::string& line : unread_tags_text(count.sample, count.tags, reading))
        fmt::print("{}\n", line);
    return exit_done;
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ReplayOptions>();
    CLI::App* command = app.add_subcommand(
        "replay",
        "Find the fiducials in images that exist; writes detections.csv (px) and displacements.csv (um)");
    command
        ->add_option("INPUT", options->inputs,
                     "Recording folders (EuRoC layout), image folders, videos, images, stacks (TIFF)")
        ->required()
        ->option_text("...");
    add_rig_option(*command, options->rig_file);
    command->add_option("--out", options->out, "New folder for the results")
        ->type_name("DIR")
        ->capture_default_str();
    add_tag_options(*command, options->tags);
    add_example(*command, "fidservo replay photos/ --out photos-tags");
    command->callback([options, command, &exit_code] {
        options->rig_is_given = command->count("--rig") > 0;
        exit_code = run_replay(*options);
    });
}

}  // namespace fidservo
