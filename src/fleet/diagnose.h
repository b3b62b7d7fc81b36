// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// fidservo fleet diagnose: a campaign a task.
#include "src/fleet/fleet_run.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo::fleet {

struct DiagnoseRequest {
    std::vector<std::filesystem::path> campaigns;  ///< a folder of recordings each, or a recording
    std::filesystem::path rig_file, effects_file;  ///< no effects file: empty
    std::vector<std::string> only, without, matters;
    /// What a diagnosis may search, in seconds of effort (gap::Seconds::by_effort); longer where recordings
    /// are (src/diagnose/time_limit.h).
    double effort_s = 0.0;
    RunOptions run;
};

/// What `diagnose` takes for recordings of ten minutes or less.
double usual_effort_s();

/// Diagnoses each campaign that has no result yet, in one thread each, its budget counted in effort. Throws
/// InputError where something that was given is wrong or not there, before the first task.
/// @return the exit code, of run_fleet()
int diagnose_fleet(const DiagnoseRequest& request);

}  // namespace fidservo::fleet
