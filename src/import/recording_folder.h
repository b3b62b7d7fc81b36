// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Writes an imported recording as a folder, with every number as it was logged.
#include "src/import/assemble.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo::imports {

/// Writes the folder whole or not at all: it has another name until everything is in it. Throws InputError if
/// it exists, a frame cannot be decoded or an interrupt was requested; RunFault if the disk does not take it.
void write_folder(const std::filesystem::path& folder, const Assembled& made);

/// stage0/data.csv: each column with the decimals that its log has, or else with the fewest, from those of a
/// recording up to 12, that restore every number exactly; else each number in its shortest form.
std::string stage_text(const Recording& recording, const std::array<int, stage_columns.size()>& decimals);

/// cam0/detections.csv in the same way.
std::string detections_text(const std::vector<TagDetection>& detections);

}  // namespace fidservo::imports
