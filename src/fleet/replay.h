// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// fidservo fleet replay: each stretch of images is a task.
#include "src/fleet/fleet_run.h"
#include "src/images/image_names.h"
#include "vision/tags/tag_book.h"

#include <filesystem>
#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::fleet {

struct ReplayRequest {
    std::vector<std::filesystem::path> inputs;
    std::filesystem::path rig_file;
    bool rig_is_given = false;  ///< whether images of the rig camera's size count as taken by that camera
    NameTimes name_times = NameTimes::automatic;
    vision::TagReading reading;  ///< how tags are to be read
    RunOptions run;
};

/// Finds the tags in each stretch that has no result yet, in one thread each. Once all stretches have a
/// result, of whatever shard, writes FLEET/detections.csv and FLEET/displacements.csv, byte for byte as a
/// single `replay` of all inputs would. Displacements are relative to a tag's first detection, which may be
/// in an earlier stretch; the results therefore contain positions, and displacements are computed here.
/// Throws InputError.
/// @param rig  of the request's rig file; it has fiducials
/// @return the exit code, of run_fleet()
int replay_fleet(const ReplayRequest& request, const Rig& rig);

}  // namespace fidservo::fleet
