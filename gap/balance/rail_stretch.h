// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The stretch of its rail on which a carriage has slid most, where position-dependent effects are searched
// for.
//
// A motor that turns continuously covers so long a way that as many places and periods would have to be tried
// as there are rows; any part of the way shows what depends on the position.
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

/// The whole range of the rows' positions up to 400 mm, which is eight of the longest periods searched for;
/// of a longer range the 400 mm with the most rows. Demands at least one row.
RailStretch most_visited(std::span<const SlidingRow> rows);

}  // namespace fidservo::gap
