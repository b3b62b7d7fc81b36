// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/time_limit.h"

#include <algorithm>

namespace fidservo::diagnose {

TimeLimit time_limit(const std::vector<Recording>& recordings) {
    constexpr double per_hour_s = 84.0, short_s = 600.0;
    double recorded_s = 0.0;
    for (const Recording& recording : recordings)
        recorded_s += static_cast<double>(recording.rows.size()) * recording.tick_s;
    const double times = 1.0 + per_hour_s * std::max(0.0, recorded_s - short_s) / 3600.0 /
                                   (half_a_minute.whole_s + half_a_minute.equation_s);
    return {times * half_a_minute.search_s, times * half_a_minute.whole_s, times * half_a_minute.equation_s};
}

}  // namespace fidservo::diagnose
