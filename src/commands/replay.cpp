// fidservo replay: the analysis of a run on images that exist already.
#include "src/replay/replay.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "src/commands/commands.h"
#include "src/config/rig_file.h"
#include "src/config/tag_print_keys.h"
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
    std::string name_times;
    std::string family;
    int border_cells = 0;  ///< 0: as in the rig file
    bool inverted = false, mirrored = false;
};

void print_notes(const std::vector<std::string>& notes) {
    for (const std::string& note : notes) spdlog::info("{}", note);
}

NameTimes asked_name_times(const std::string& word) {
    if (const auto known = name_times_of(word)) return *known;
    throw InputError(fmt::format("--name-times: {}: must be none, s, ms, us or ns", word));
}

/// As which tags are looked for: what the options say, over what a rig file that was given says.
vision::TagReading reading_of(const ReplayOptions& options, const FiducialParameters& fiducials) {
    vision::TagReading reading{options.rig_is_given ? fiducials.print : TagPrint{}, options.mirrored};
    if (!options.family.empty()) {
        reading.print = {.family = find_tag_family(options.family)};
        if (reading.print.family == nullptr)
            throw InputError(
                fmt::format("--family: {}: must be one of {}", options.family, names_of_tag_families()));
    }
    if (options.border_cells > 0) reading.print.border_cells = options.border_cells;
    if (reading.print.border_cells == 2 && !reading.print.family->has_plain_border())
        throw InputError(fmt::format("--border-cells: 2: must be 1: {} has no plain border to make wider",
                                     reading.print.family->name));
    if (options.inverted) reading.print.inverted = true;
    return reading;
}

int run_replay(const ReplayOptions& options) {
    const Rig rig = load_rig(options.rig_file);
    if (!rig.fiducials)
        throw InputError(fmt::format("{}: fiducials: missing: their side_mm is the scale of displacements",
                                     options.rig_file.string()));
    const vision::TagReading reading = reading_of(options, *rig.fiducials);
    ImageFrames frames(options.inputs, {.name_times = asked_name_times(options.name_times)});
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
    command
        ->add_option(
            "--name-times", options->name_times,
            "What the images' names in a folder are times in; else taken where they have 19 digits (ns) "
            "or 10 and a fraction (s)")
        ->type_name("none|s|ms|us|ns");
    command->add_option("--out", options->out, "New folder for the results")
        ->type_name("DIR")
        ->capture_default_str();
    command
        ->add_option(
            "--family", options->family,
            "Of the tags: tag36h11, tag25h9, tag16h5, tagStandard41h12, DICT_4X4_50 to DICT_7X7_1000; "
            "else the rig file's, if one is given, or tag36h11")
        ->type_name("NAME");
    command
        ->add_option("--border-cells", options->border_cells,
                     "Width of the tags' border in cells; 2 on a kalibr AprilGrid")
        ->type_name("1|2")
        ->check(CLI::Range(1, 2));
    command->add_flag("--inverted", options->inverted, "The tags are white on black");
    command->add_flag("--mirrored", options->mirrored,
                      "The images are mirrored, e.g. taken through the glass that the tags are printed on");
    add_example(*command, "fidservo replay photos/ --out photos-tags");
    command->callback([options, command, &exit_code] {
        options->rig_is_given = command->count("--rig") > 0;
        exit_code = run_replay(*options);
    });
}

}  // namespace fidservo
