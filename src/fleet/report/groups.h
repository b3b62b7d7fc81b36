// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Groups of units that may share a cause: units with the same label, with the same rig file, with their first
// recording in the same week, or with a change at the same date.
#include "src/fleet/report/findings.h"

#include <span>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// Groups of at least two units and at most all but one; identical groups are listed once. Units are indices
/// in `units`.
std::vector<UnitGroup> groups_of(const std::vector<FleetResult>& results,
                                 const std::vector<UnitHistory>& histories,
                                 std::span<const UnitFindings> units);

/// Changes of several units that may be one event: they have the same sign, and the date of each is within
/// the intervals of all others. Or the change of a single unit.
struct ChangeCluster {
    ChangeKind kind;
    /// Indices in `units`, and for each unit the index of its change.
    std::vector<std::size_t> units, changes;
    Dates since;  ///< dates that are compatible with all of these changes
};

/// All changes of a quantity, those of most units first.
std::vector<ChangeCluster> clusters_of(const std::vector<FleetResult>& results,
                                       std::span<const UnitFindings> units);

/// When a change began.
Dates dates_of(const std::vector<FleetResult>& results, const UnitFindings& unit, const Change& change);

/// The overlap of two sets of units: intersection over union.
double overlap(std::vector<std::size_t> a, std::vector<std::size_t> b);

}  // namespace fidservo::fleet
