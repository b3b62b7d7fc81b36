// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/carriage_run.h"

#include "calib/macro/macro_trace.h"
#include "core/macro_parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fidservo::gap {

namespace {

/// Successive rows with the same reading.
struct Dwell {
    std::size_t first, end;
    double reading_count;
};

std::vector<Dwell> dwells(const std::vector<double>& reading_count) {
    std::vector<Dwell> all;
    for (std::size_t k = 0; k < reading_count.size(); ++k) {
        if (all.empty() || reading_count[k] != all.back().reading_count)
            all.push_back({k, k, reading_count[k]});
        all.back().end = k + 1;
    }
    return all;
}

/// Index behind the last dwell of a flicker: from `first` on, readings alternate between those of the first
/// two dwells.
std::size_t end_of_flicker(const std::vector<Dwell>& all, std::size_t first) {
    if (first + 1 == all.size() || std::abs(all[first + 1].reading_count - all[first].reading_count) != 1.0)
        return first + 1;
    std::size_t end = first + 2;
    while (end < all.size() && all[end].reading_count == all[end - 2].reading_count) ++end;
    return end;
}

/// For each row, whether the reading is constant or alternates between two counts in the 50 ms before and
/// after it.
std::vector<bool> standing_rows(const CarriageRun& run) {
    const std::size_t rows = run.reading_count.size(), reach = lead_rows(run.tick_s) / 2;
    std::vector<bool> stands(rows, false);
    const auto stands_between = [&](std::size_t first, std::size_t end) {
        const std::size_t from = first == 0 ? 0 : first + reach,
                          to = end == rows ? rows : end - std::min(end, reach);
        for (std::size_t k = from; k < to; ++k) stands[k] = true;
    };
    const std::vector<Dwell> all = dwells(run.reading_count);
    for (std::size_t d = 0; d < all.size(); ++d) {
        stands_between(all[d].first, all[d].end);
        const std::size_t end = end_of_flicker(all, d);
        const bool to_and_fro = end > d + 2;
        if (to_and_fro) stands_between(all[d].first, all[end - 1].end);
    }
    return stands;
}

/// Which rows of a usable stretch are free of the ends of travel.
std::vector<bool> free_rows(const CarriageRun& run, const Stretch& stretch, const MacroParameters& macro,
                            const calib::Travel& travel) {
    calib::MacroTrace trace{{}, run.tick_s, {}, {}};
    for (std::size_t k = stretch.first; k < stretch.end; ++k) {
        trace.command_V.push_back(run.command_V[k]);
        trace.position_mm.push_back(run.reading_count[k] * macro.encoder_resolution_mm);
    }
    return calib::free_ticks(trace, macro.encoder_resolution_mm, travel);
}

}  // namespace

double reading_count(const StageRow& row, const MacroParameters& macro) {
    return std::isfinite(row.encoder_count) ? row.encoder_count
                                            : row.position_mm / macro.encoder_resolution_mm;
}

double time_constant_s(const MacroParameters& macro, double tick_s) {
    return -tick_s / std::log(macro.velocity_pole);
}

std::vector<double> readings_mm(const Recording& recording, const MacroParameters& macro) {
    std::vector<double> all;
    all.reserve(recording.rows.size());
    for (const StageRow& row : recording.rows)
        all.push_back(macro.encoder_resolution_mm * reading_count(row, macro));
    return all;
}

CarriageRun carriage_run(const Recording& recording, const MacroParameters& macro, bool is_homed) {
    CarriageRun run;
    run.tick_s = recording.tick_s;
    std::vector<bool> usable;
    for (const StageRow& row : recording.rows) {
        run.time_s.push_back(seconds(row.time_ns - recording.rows.front().time_ns));
        run.command_V.push_back(row.macro_command_V);
        run.reading_count.push_back(reading_count(row, macro));
        usable.push_back(std::isfinite(run.command_V.back()) && std::isfinite(run.reading_count.back()));
    }
    run.way = counted_way(run.reading_count);
    run.stands = standing_rows(run);
    run.is_homed = is_homed;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const calib::Travel travel =
        run.is_homed ? calib::Travel{macro.low_mm, macro.high_mm} : calib::Travel{-infinity, infinity};
    const std::vector<Stretch> whole = stretches(recording, usable);
    for (const Stretch& stretch : whole) {
        const std::vector<bool> free = free_rows(run, stretch, macro, travel);
        std::copy(free.begin(), free.end(), usable.begin() + static_cast<std::ptrdiff_t>(stretch.first));
    }
    for (const Stretch& stretch : stretches(recording, usable)) {
        auto windows = cut(stretch, recording.tick_s, LeadIn::estimates_state);
        if (windows.empty()) continue;
        const auto around = std::ranges::find_if(
            whole, [&](const Stretch& all) { return all.first <= stretch.first && stretch.end <= all.end; });
        if (!run.run_on_end.empty())
            run.run_on_end.back() = std::min(run.run_on_end.back(), windows.front().lead);
        run.run_on_end.push_back(around->end);
        run.windows.push_back(std::move(windows));
    }
    return run;
}

double beyond_rounding(double error_count) {
    return std::copysign(std::max(0.0, std::abs(error_count) - 0.5), error_count);
}

double counted_error(const CarriageRun& run, std::size_t row, double predicted_count) {
    const double error = predicted_count - run.reading_count[row];
    return run.stands[row] ? beyond_rounding(error) : error;
}

}  // namespace fidservo::gap
