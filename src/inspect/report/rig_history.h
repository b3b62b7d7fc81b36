// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a rig's inspections have said of it, run after run, and whether it has changed.
//
// A line a run, in the form of a fleet's result (fidservo-fleet-result/1), whose unit and labels are those of
// its recordings; without a unit it is the rig's name. The same statistics say whether a size has made a step
// or goes on changing (src/fleet/report/statistics/change_points.h). A file may hold the runs of several
// units.
#include "src/files/recording/description.h"
#include "src/inspect/report/rig_findings.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::inspect {

/// The findings from the history.
struct HistoryFindings {
    std::vector<std::string> lines;  ///< for a terminal
    std::string html;                ///< for the report's section
};

/// Appends a run's findings, on the disk before it returns, and judges the whole history: changes of the
/// run's own unit are said. Lines that are no results (a run was killed while it wrote) are passed over,
/// which is said. Where nothing was diagnosed nothing is appended.
/// @param origin  unit, labels and, in UTC, the time of the run: 2026-11-02T08:15:00Z
/// Throws RunFault if the disk does not take the line.
HistoryFindings append_to_history(const std::filesystem::path& file, const Rig& rig,
                                  const std::string& rig_sha256, const RigFindings& findings,
                                  const RecordingOrigin& origin);

}  // namespace fidservo::inspect
