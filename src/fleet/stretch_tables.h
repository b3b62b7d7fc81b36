// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The results of all stretches as the tables of one `replay`.
#include "src/fleet/stretch.h"
#include "src/images/image_frames.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// Writes detections.csv and displacements.csv of all stretches, in order, and says how many images and tags
/// there are. Each takes the place of an earlier one in one step. One result at a time is in memory. Throws
/// RunFault if a result cannot be read or the disk fails.
/// @param results  by stretch, their files in `folder`
void write_replay_tables(const std::filesystem::path& fleet, const std::filesystem::path& folder,
                         const ImageFrames& frames, const std::vector<Stretch>& stretches,
                         const std::map<std::size_t, std::string>& results, double tag_side_mm);

}  // namespace fidservo::fleet
