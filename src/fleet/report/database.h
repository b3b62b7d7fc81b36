// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The results of a fleet in SQLite: FLEET/fleet.sqlite, for the report and for queries by users. Its tables
// are described in docs/fleet-report.md.
#include "src/fleet/report/result.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// The result of updating the database.
struct Collected {
    std::vector<FleetResult> results;    ///< all results in it, by unit and time
    std::vector<std::string> damaged;    ///< a line for each file that is no valid result
    std::size_t added = 0, removed = 0;  ///< number of new or changed files, and of files that are gone
};

/// Brings FLEET/fleet.sqlite up to date with FLEET/results: new and changed files are read, rows of missing
/// or damaged files are removed, all in one transaction. A second call changes nothing. Throws InputError if
/// there is no FLEET/results or the database was not made by this program; RunFault if the disk fails.
Collected collect_results(const std::filesystem::path& fleet);

}  // namespace fidservo::fleet
