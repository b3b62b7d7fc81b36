// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/balance/rail_stretch.h"

#include "core/demand.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace fidservo::gap {

RailStretch most_visited(std::span<const SlidingRow> rows) {
    FIDSERVO_DEMAND(!rows.empty());
    constexpr double longest_mm = 400.0;
    std::vector<double> places_mm;
    places_mm.reserve(rows.size());
    for (const SlidingRow& row : rows) places_mm.push_back(row.position_mm);
    std::ranges::sort(places_mm);
    std::size_t best = 0, most = 0, end = 0;
    for (std::size_t first = 0; first < places_mm.size(); ++first) {
        while (end < places_mm.size() && places_mm[end] <= places_mm[first] + longest_mm) ++end;
        if (end - first <= most) continue;
        most = end - first;
        best = first;
    }
    return {places_mm[best], places_mm[best + most - 1]};
}

}  // namespace fidservo::gap
