// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is looked for in images that exist, as users say it: `replay`, `fleet replay` and Python.
#include "core/rig.h"
#include "src/images/image_names.h"
#include "vision/tags/tag_book.h"

#include <filesystem>
#include <string>

namespace fidservo {

struct TagOptions {
    std::string name_times;
    std::string family;    ///< empty: as in the rig file
    int border_cells = 0;  ///< 0: as in the rig file
    bool inverted = false, mirrored = false;
};

/// Throws InputError with the file where a rig has no fiducials: their size is the scale of displacements.
void demand_fiducials(const Rig& rig, const std::filesystem::path& rig_file);

/// Throws InputError where --name-times is none of its words.
NameTimes name_times_of(const TagOptions& options);

/// As which tags are looked for: what the options say, over how a rig's are printed. Throws InputError.
/// @param print  of a rig file that was given; else the usual one
vision::TagReading reading_of(const TagOptions& options, const TagPrint& print);

}  // namespace fidservo
