// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the commands that look for tags in images that exist are told what to look for.
#include "core/plate.h"
#include "core/rig.h"
#include "src/images/image_names.h"
#include "vision/tags/tag_book.h"

#include <filesystem>
#include <string>

#include <CLI/App.hpp>

namespace fidservo {

struct TagOptions {
    std::string name_times;
    std::string family;
    int border_cells = 0;  ///< 0: as in the rig file
    bool inverted = false, mirrored = false;
};

/// --name-times, --family, --border-cells, --inverted, --mirrored.
void add_tag_options(CLI::App& command, TagOptions& options);

/// Throws InputError with the file where a rig has no fiducials: their size is the scale of displacements.
void demand_fiducials(const Rig& rig, const std::filesystem::path& rig_file);

/// Throws InputError where --name-times is none of its words.
NameTimes name_times_of(const TagOptions& options);

/// As which tags are looked for: what the options say, over what a rig file that was given says. Throws
/// InputError.
vision::TagReading reading_of(const TagOptions& options, const FiducialParameters& fiducials,
                              bool rig_is_given);

}  // namespace fidservo
