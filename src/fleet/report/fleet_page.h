// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/fleet/report/database.h"
#include "src/fleet/report/findings.h"

#include <filesystem>
#include <string>

namespace fidservo::fleet {

/// The report of a fleet: one self-contained HTML file (docs/fleet-report.md).
/// @param fleet  its folder, for the page's title
/// @param cured  the rig file that was written; empty: none
std::string fleet_page(const std::filesystem::path& fleet, const Collected& collected,
                       const FleetFindings& findings, const std::filesystem::path& cured);

}  // namespace fidservo::fleet
