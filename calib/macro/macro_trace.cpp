// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_trace.h"

#include "core/demand.h"

#include <algorithm>
#include <cmath>

namespace fidservo::calib {

namespace {

/// Index after the last tick from `k` on at which the carriage stays within half a count of where it is at k.
std::size_t end_of_rest(const MacroTrace& trace, std::size_t k, double resolution_mm) {
    std::size_t end = k;
    while (end < trace.position_mm.size() &&
           std::abs(trace.position_mm[end] - trace.position_mm[k]) < 0.5 * resolution_mm)
        ++end;
    return end;
}

/// Whether the carriage came to tick k fast, rests from there to `end`, and is pushed on for 20 ms at least.
bool is_impact(const MacroTrace& trace, std::size_t k, std::size_t end, double resolution_mm) {
    constexpr std::size_t run_up = 5;
    constexpr double least_rest_s = 0.020, same_push = 0.9;
    const auto least_rest = static_cast<std::size_t>(std::ceil(least_rest_s / trace.tick_s));
    if (k < run_up || end - k < least_rest) return false;
    const double way_mm = trace.position_mm[k] - trace.position_mm[k - run_up];
    if (std::abs(way_mm) < run_up * resolution_mm) return false;
    const double side = std::copysign(1.0, way_mm);
    double push_V = 0.0;
    for (std::size_t i = k - run_up; i < k; ++i) push_V += side * trace.command_V[i] / run_up;
    const auto rest = std::span(trace.command_V).subspan(k, least_rest);
    return push_V > 0.0 &&
           std::all_of(rest.begin(), rest.end(), [&](double u) { return side * u >= same_push * push_V; });
}

}  // namespace

std::vector<MacroTrace> macro_traces(const Recording& recording, double resolution_mm, std::size_t index) {
    constexpr double late = 1.5;  // ticks between rows from which on one is missing
    std::vector<MacroTrace> traces;
    bool open = false;
    TimeNs last_ns = 0;
    for (const StageRow& row : recording.rows) {
        const double position_mm =
            recording.columns.encoder ? row.encoder_count * resolution_mm : row.position_mm;
        const bool usable = std::isfinite(position_mm) && std::isfinite(row.macro_command_V);
        const bool follows = open && seconds(row.time_ns - last_ns) < late * recording.tick_s;
        if (usable && !follows) traces.push_back({recording.name, recording.tick_s, {}, {}, index});
        if (usable) {
            traces.back().command_V.push_back(row.macro_command_V);
            traces.back().position_mm.push_back(position_mm);
        }
        open = usable;
        last_ns = row.time_ns;
    }
    return traces;
}

std::vector<bool> free_ticks(const MacroTrace& trace, double resolution_mm, const Travel& travel) {
    FIDSERVO_DEMAND(trace.command_V.size() == trace.position_mm.size());
    const double margin_mm = 2.0 * resolution_mm;
    std::vector<bool> free(trace.position_mm.size());
    for (std::size_t k = 0; k < free.size(); ++k)
        free[k] = trace.position_mm[k] > travel.low_mm + margin_mm &&
                  trace.position_mm[k] < travel.high_mm - margin_mm;
    for (std::size_t k = 0; k < free.size();) {
        const std::size_t end = std::max(k + 1, end_of_rest(trace, k, resolution_mm));
        if (is_impact(trace, k, end, resolution_mm))
            std::fill(free.begin() + static_cast<std::ptrdiff_t>(k),
                      free.begin() + static_cast<std::ptrdiff_t>(end), false);
        k = end;
    }
    return free;
}

std::vector<MacroWindow> cut_windows(const MacroTrace& trace, const std::vector<bool>& free, double window_s,
                                     double least_s) {
    FIDSERVO_DEMAND(free.size() == trace.position_mm.size() && window_s > 0.0 && trace.tick_s > 0.0);
    const auto ticks = [&](double time_s) {
        return std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(time_s / trace.tick_s)));
    };
    const std::size_t window = ticks(window_s), least = ticks(least_s);
    std::vector<MacroWindow> windows;
    for (std::size_t begin = 0; begin < free.size();) {
        std::size_t end = begin;
        while (end < free.size() && free[end]) ++end;
        const std::size_t length = end - begin;
        const std::size_t pieces = std::max<std::size_t>(1, (length + window / 2) / window);
        for (std::size_t i = 0; i < pieces && length >= least; ++i) {
            const std::size_t from = begin + length * i / pieces, to = begin + length * (i + 1) / pieces;
            windows.push_back({std::span(trace.command_V).subspan(from, to - from),
                               std::span(trace.position_mm).subspan(from, to - from), trace.tick_s,
                               trace.recording, static_cast<double>(from) * trace.tick_s});
        }
        begin = end + 1;
    }
    return windows;
}

}  // namespace fidservo::calib
