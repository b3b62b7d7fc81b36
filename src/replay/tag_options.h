// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The tags that are looked for in existing images, as the options of `replay`, `fleet replay` and Python
// state it.
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

/// Throws InputError if the argument of --name-times is invalid.
NameTimes name_times_of(const TagOptions& options);

/// The reading of tags: the options' where given, else that of the rig's tags. Throws InputError.
/// @param print  of a given rig file, or the default
vision::TagReading reading_of(const TagOptions& options, const TagPrint& print);

}  // namespace fidservo
