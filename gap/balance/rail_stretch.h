// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where on its rail a carriage has slid most: where what depends on the place is looked for.
//
// A motor that turns on and on goes so far that as many places and periods would have to be tried as there
// are rows; it shows what depends on the place on any part of its way.
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

/// All of the rows' way up to 400 mm, which is eight of the longest periods that are looked for; of a longer
/// way the 400 mm in which most rows lie. Demands a row.
RailStretch most_visited(std::span<const SlidingRow> rows);

}  // namespace fidservo::gap
