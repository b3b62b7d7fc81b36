// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a rig's inspections have said of it, run after run, and whether it has changed.
//
// A line a run, in the form of a fleet's result (fidservo-fleet-result/1), whose unit is the rig: the same
// statistics say whether a size has made a step or goes on changing
// (src/fleet/report/statistics/change_points.h).
#include "src/inspect/report/rig_findings.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::inspect {

/// What the history says.
struct HistoryFindings {
    std::vector<std::string> lines;  ///< for a terminal
    std::string html;                ///< for the report's section
};

/// Appends a run's findings, on the disk before it returns, and judges the whole history. Lines that are no
/// results (a run was killed while it wrote) are passed over, which is said. Where nothing was diagnosed
/// nothing is appended.
/// @param recorded_at  UTC, 2026-11-02T08:15:00Z
/// Throws RunFault if the disk does not take the line.
HistoryFindings append_to_history(const std::filesystem::path& file, const Rig& rig,
                                  const std::string& rig_sha256, const RigFindings& findings,
                                  const std::string& recorded_at);

}  // namespace fidservo::inspect
