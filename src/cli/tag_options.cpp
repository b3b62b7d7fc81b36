// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/tag_options.h"

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

}  // namespace fidservo
