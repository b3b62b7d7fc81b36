// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/evidence/late_ticks.h"

#include "gap/numbers.h"

#include <cmath>
#include <utility>

namespace fidservo::gap {

namespace {

/// Number of ticks missing between a row and the next; 0 where the time between them is not a whole number of
/// ticks, or more than 0.1 s.
std::size_t ticks_between(const StageRow& row, const StageRow& next, double tick_s) {
    constexpr double off_time = 0.1;  // in ticks
    const double pause_s = seconds(next.time_ns - row.time_ns);
    const double ticks = pause_s / tick_s, whole = std::round(ticks);
    if (whole < 2.0 || pause_s > longest_pause_s || std::abs(ticks - whole) > off_time) return 0;
    return static_cast<std::size_t>(whole) - 1;
}

StageRow between(const StageRow& row, const StageRow& next, double share) {
    const auto on_line = [&](double StageRow::*reading) {
        return row.*reading + share * (next.*reading - row.*reading);
    };
    StageRow filled = row;
    filled.time_ns = row.time_ns + std::llround(share * static_cast<double>(next.time_ns - row.time_ns));
    filled.encoder_count = std::round(on_line(&StageRow::encoder_count));
    filled.hall_adc = std::round(on_line(&StageRow::hall_adc));
    filled.position_mm = on_line(&StageRow::position_mm);
    return filled;
}

}  // namespace

LateTicks fill_late_ticks(Recording& recording) {
    constexpr std::size_t most = 2;
    std::vector<StageRow> rows;
    LateTicks late;
    rows.reserve(recording.rows.size());
    late.is_filled.reserve(recording.rows.size());
    for (std::size_t k = 0; k < recording.rows.size(); ++k) {
        const StageRow& row = recording.rows[k];
        rows.push_back(row);
        late.is_filled.push_back(false);
        if (k + 1 == recording.rows.size()) break;
        const StageRow& next = recording.rows[k + 1];
        const std::size_t left_out = ticks_between(row, next, recording.tick_s);
        late.left_out += left_out;
        if (left_out > most) continue;
        for (std::size_t tick = 1; tick <= left_out; ++tick) {
            rows.push_back(between(row, next, static_cast<double>(tick) / static_cast<double>(left_out + 1)));
            late.is_filled.push_back(true);
        }
    }
    recording.rows = std::move(rows);
    return late;
}

}  // namespace fidservo::gap
