// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/fleet/report/database.h"
#include "src/fleet/report/findings.h"

#include <filesystem>
#include <string>

namespace fidservo::fleet {

/// The file of `fleet report --json`: format fidservo-fleet/1 (docs/fleet-report.md).
/// @param cured  the rig file that was written; empty: none
std::string fleet_json(const Collected& collected, const FleetFindings& findings,
                       const std::filesystem::path& cured);

}  // namespace fidservo::fleet
