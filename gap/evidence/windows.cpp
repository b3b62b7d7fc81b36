// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/evidence/windows.h"

#include "core/demand.h"
#include "gap/numbers.h"

#include <algorithm>
#include <cmath>

namespace fidservo::gap {

namespace {

constexpr double least_s = 0.3;

std::size_t rows_of(double time_s, double tick_s) {
    return std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(time_s / tick_s)));
}

}  // namespace

std::vector<Stretch> stretches(const Recording& recording, const std::vector<bool>& usable) {
    FIDSERVO_DEMAND(usable.size() == recording.rows.size());
    std::vector<Stretch> found;
    bool open = false;
    for (std::size_t k = 0; k < usable.size(); ++k) {
        const bool follows = open && seconds(recording.rows[k].time_ns - recording.rows[k - 1].time_ns) <
                                         most_steps_apart * recording.tick_s;
        if (usable[k] && !follows) found.push_back({k, k});
        if (usable[k]) found.back().end = k + 1;
        open = usable[k];
    }
    return found;
}

std::vector<WindowRows> cut(const Stretch& stretch, double tick_s, LeadIn lead_in) {
    const std::size_t lead = lead_in == LeadIn::none ? 0 : lead_rows(tick_s);
    const std::size_t whole = rows_of(window_s, tick_s), least = rows_of(least_s, tick_s);
    std::vector<WindowRows> windows;
    for (std::size_t first = stretch.first + lead; first + least <= stretch.end; first += whole)
        windows.push_back({first - lead, first, std::min(first + whole, stretch.end)});
    return windows;
}

std::size_t lead_rows(double tick_s) {
    return rows_of(lead_s, tick_s);
}

}  // namespace fidservo::gap
