// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/tag_options.h"

#include "core/input_error.h"
#include "src/files/rig/tag_print_keys.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>

namespace fidservo {

void add_tag_options(CLI::App& command, TagOptions& options) {
    command
        .add_option(
            "--name-times", options.name_times,
            "What the images' names in a folder are times in; else taken where they have 19 digits (ns) "
            "or 10 and a fraction (s)")
        ->type_name("none|s|ms|us|ns");
    command
        .add_option(
            "--family", options.family,
            "Of the tags: tag36h11, tag25h9, tag16h5, tagStandard41h12, DICT_4X4_50 to DICT_7X7_1000; "
            "else the rig file's, if one is given, or tag36h11")
        ->type_name("NAME");
    command
        .add_option("--border-cells", options.border_cells,
                    "Width of the tags' border in cells; 2 on a kalibr AprilGrid")
        ->type_name("1|2")
        ->check(CLI::Range(1, 2));
    command.add_flag("--inverted", options.inverted, "The tags are white on black");
    command.add_flag("--mirrored", options.mirrored,
                     "The images are mirrored, e.g. taken through the glass that the tags are printed on");
}

void demand_fiducials(const Rig& rig, const std::filesystem::path& rig_file) {
    if (!rig.fiducials)
        throw InputError(fmt::format("{}: fiducials: missing: their side_mm is the scale of displacements",
                                     rig_file.string()));
}

NameTimes name_times_of(const TagOptions& options) {
    if (const auto known = name_times_of(options.name_times)) return *known;
    throw InputError(fmt::format("--name-times: {}: must be none, s, ms, us or ns", options.name_times));
}

vision::TagReading reading_of(const TagOptions& options, const FiducialParameters& fiducials,
                              bool rig_is_given) {
    vision::TagReading reading{rig_is_given ? fiducials.print : TagPrint{}, options.mirrored};
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

}  // namespace fidservo
