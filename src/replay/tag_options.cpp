// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/replay/tag_options.h"

#include "core/input_error.h"
#include "src/files/rig/tag_print_keys.h"

#include <fmt/format.h>

namespace fidservo {

void demand_fiducials(const Rig& rig, const std::filesystem::path& rig_file) {
    if (!rig.fiducials)
        throw InputError(fmt::format("{}: fiducials: missing: their side_mm is the scale of displacements",
                                     rig_file.string()));
}

NameTimes name_times_of(const TagOptions& options) {
    if (const auto known = name_times_of(options.name_times)) return *known;
    throw InputError(fmt::format("--name-times: {}: must be none, s, ms, us or ns", options.name_times));
}

vision::TagReading reading_of(const TagOptions& options, const TagPrint& print) {
    vision::TagReading reading{print, options.mirrored};
    if (!options.family.empty()) {
        reading.print = {.family = find_tag_family(options.family)};
        if (reading.print.family == nullptr)
            throw InputError(
                fmt::format("--family: {}: must be one of {}", options.family, names_of_tag_families()));
    }
    if (options.border_cells < 0 || options.border_cells > 2)
        throw InputError(fmt::format("--border-cells: {}: must be 1 or 2; 0 stands for the rig file's",
                                     options.border_cells));
    if (options.border_cells > 0) reading.print.border_cells = options.border_cells;
    if (reading.print.border_cells == 2 && !reading.print.family->has_plain_border())
        throw InputError(fmt::format("--border-cells: 2: must be 1: {} has no plain border to make wider",
                                     reading.print.family->name));
    if (options.inverted) reading.print.inverted = true;
    return reading;
}

}  // namespace fidservo
