// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which units may share a cause: by a label of their recordings, by when they were first recorded, by when
// they changed.
#include "src/fleet/report/findings.h"

#include <span>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// Sets of two units or more, of all but one at most; of sets that are the same the first. Units are places
/// in `units`.
std::vector<UnitGroup> groups_of(const std::vector<FleetResult>& results,
                                 const std::vector<UnitHistory>& histories,
                                 std::span<const UnitFindings> units);

/// Changes of several units that may be one, in the same direction: the date of each lies within the interval
/// of every other's; or one of a single unit.
struct ChangeCluster {
    ChangeKind kind;
    std::vector<std::size_t> units, changes;  ///< places in `units`; of each the change
    Dates since;                              ///< that all of them allow
};

/// All changes of a quantity, those of most units first.
std::vector<ChangeCluster> clusters_of(const std::vector<FleetResult>& results,
                                       std::span<const UnitFindings> units);

/// When a change began.
Dates dates_of(const std::vector<FleetResult>& results, const UnitFindings& unit, const Change& change);

/// How much two sets of units are the same: of those in one or the other the share that is in both.
double overlap(std::vector<std::size_t> a, std::vector<std::size_t> b);

}  // namespace fidservo::fleet
