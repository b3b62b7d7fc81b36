// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The part of the rail on which the carriage has slid most. Position-dependent effects are searched for in
// this part only.
//
// A motor that turns continuously covers so long a range of positions that far too many places and periods
// would have to be tried; effects that depend on the position show in any part of the range.
#include "gap/balance/carriage_forces.h"

#include <span>

namespace fidservo::gap {

struct RailStretch {
    double low_mm = 0.0, high_mm = 0.0;
    double length_mm() const { return high_mm - low_mm; }
    bool holds(const SlidingRow& row) const {
        return low_mm <= row.position_mm && row.position_mm <= high_mm;
    }
};

/// The range of the rows' positions if it is at most 400 mm long (eight of the longest periods searched for),
/// otherwise the 400 mm with the most rows. Requires at least one row.
RailStretch most_visited(std::span<const SlidingRow> rows);

}  // namespace fidservo::gap
