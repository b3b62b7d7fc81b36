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
    bool rig_is_given = false;  ///< images of the rig camera's size are taken by that camera
    NameTimes name_times = NameTimes::automatic;
    vision::TagReading reading;  ///< how tags are to be read
    RunOptions run;
};

/// Finds the tags in each stretch that has no result yet, in one thread each. Once all stretches have one,
/// whichever share made them, writes FLEET/detections.csv and FLEET/displacements.csv, to the byte those of
/// one `replay` of all inputs: displacements count from where a tag was first seen, which may be in an
/// earlier stretch, so a result holds the tags' places, and they are counted here. Throws InputError.
/// @param rig  of the request's rig file; it has fiducials
/// @return the exit code, of run_fleet()
int replay_fleet(const ReplayRequest& request, const Rig& rig);

}  // namespace fidservo::fleet
