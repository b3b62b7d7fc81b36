// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// fidservo fleet diagnose: each campaign is a task.
#include "src/diagnose/diagnose_recordings.h"
#include "src/fleet/fleet_run.h"

#include <filesystem>
#include <vector>

namespace fidservo::fleet {

struct DiagnoseRequest {
    std::vector<std::filesystem::path> campaigns;  ///< folders of recordings, or single recordings
    std::filesystem::path rig_file;
    diagnose::Asked asked;
    double effort_s = diagnose::usual_effort_s();  ///< diagnose::Conduct::effort_s
    RunOptions run;
};

/// Diagnoses each campaign that has no result yet, each in one thread, with a budget measured in computing
/// effort. Throws InputError before the first task if an argument is wrong or a file does not exist.
/// @return the exit code, of run_fleet()
int diagnose_fleet(const DiagnoseRequest& request);

}  // namespace fidservo::fleet
