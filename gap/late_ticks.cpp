#include "gap/late_ticks.h"

#include <cmath>
#include <utility>

namespace fidservo::gap {

namespace {

/// Whole ticks from a row to the next; 1 where that is more than can be filled, or not a number of ticks.
int ticks_to(const StageRow& row, const StageRow& next, double tick_s) {
    constexpr int most = 3;
    constexpr double off_time = 0.1;  // ticks
    const double ticks = seconds(next.time_ns - row.time_ns) / tick_s;
    const double whole = std::round(ticks);
    return whole <= most && std::abs(ticks - whole) < off_time ? static_cast<int>(whole) : 1;
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

std::vector<bool> fill_late_ticks(Recording& recording) {
    std::vector<StageRow> rows;
    std::vector<bool> is_filled;
    rows.reserve(recording.rows.size());
    is_filled.reserve(recording.rows.size());
    for (std::size_t k = 0; k < recording.rows.size(); ++k) {
        const StageRow& row = recording.rows[k];
        rows.push_back(row);
        is_filled.push_back(false);
        if (k + 1 == recording.rows.size()) break;
        const StageRow& next = recording.rows[k + 1];
        const int ticks = ticks_to(row, next, recording.tick_s);
        for (int tick = 1; tick < ticks; ++tick) {
            rows.push_back(between(row, next, static_cast<double>(tick) / ticks));
            is_filled.push_back(true);
        }
    }
    recording.rows = std::move(rows);
    return is_filled;
}

}  // namespace fidservo::gap
