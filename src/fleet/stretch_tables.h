// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Joins the results of all stretches to the tables that a single `replay` would write.
#include "src/fleet/stretch.h"
#include "src/images/image_frames.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// Writes detections.csv and displacements.csv of all stretches, in order, and prints the number of images
/// and tags. Each file replaces an earlier one atomically. Only one result at a time is in memory. Throws
/// RunFault if a result cannot be read or the disk fails.
/// @param results  for each stretch, the name of its result in `folder`
void write_replay_tables(const std::filesystem::path& fleet, const std::filesystem::path& folder,
                         const ImageFrames& frames, const std::vector<Stretch>& stretches,
                         const std::map<std::size_t, std::string>& results, double tag_side_mm);

}  // namespace fidservo::fleet
