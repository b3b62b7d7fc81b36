// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An imported recording as a folder, every number as it was logged.
#include "src/import/assemble.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo::imports {

/// Writes the folder whole or not at all: it has another name until everything is in it. Throws InputError if
/// it exists, a frame cannot be decoded or an interrupt was requested; RunFault if the disk does not take it.
void write_folder(const std::filesystem::path& folder, const Assembled& made);

/// stage0/data.csv: each column with the digits behind the point that its log has, or else the fewest, from
/// those of a recording up to 12, that give every number back exactly; else the shortest of each.
std::string stage_text(const Recording& recording, const std::array<int, stage_columns.size()>& decimals);

/// cam0/detections.csv in the same way.
std::string detections_text(const std::vector<TagDetection>& detections);

}  // namespace fidservo::imports
