// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/thinned.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

namespace fidservo::diagnose {

namespace {

constexpr double most_s = 600.0, piece_s = 60.0;

double duration_s(const Recording& recording) {
    return static_cast<double>(recording.rows.size()) * recording.tick_s;
}

/// What happened from one time up to, not including, another.
template <class Timed>
std::vector<Timed> between(const std::vector<Timed>& all, TimeNs from_ns, TimeNs to_ns) {
    const auto first = std::ranges::lower_bound(all, from_ns, {}, &Timed::time_ns);
    const auto end = std::ranges::lower_bound(all, to_ns, {}, &Timed::time_ns);
    return {first, end};
}

/// Rows [first, end) of a recording and what was seen meanwhile.
Recording piece(const Recording& whole, std::size_t first, std::size_t end) {
    const RecordingHeader& header = whole;
    Recording part;
    static_cast<RecordingHeader&>(part) = header;
    part.name += fmt::format(" from {:.0f} s", static_cast<double>(first) * whole.tick_s);
    part.rows.assign(whole.rows.begin() + static_cast<std::ptrdiff_t>(first),
                     whole.rows.begin() + static_cast<std::ptrdiff_t>(end));
    const TimeNs from_ns = part.rows.front().time_ns, to_ns = part.rows.back().time_ns + 1;
    part.events = between(whole.events, from_ns, to_ns);
    part.detections = between(whole.detections, from_ns, to_ns);
    part.frames = between(whole.frames, from_ns, to_ns);
    part.appearances = between(whole.appearances, from_ns, to_ns);
    return part;
}

}  // namespace

std::vector<Recording> thinned(std::vector<Recording> recordings, std::vector<std::string>& notes) {
    double short_s = 0.0, long_s = 0.0;
    const auto is_long = [](const Recording& recording) { return duration_s(recording) > 2.0 * piece_s; };
    for (const Recording& recording : recordings)
        (is_long(recording) ? long_s : short_s) += duration_s(recording);
    const double room_s = std::max(piece_s, most_s - short_s);
    if (long_s <= room_s) return recordings;
    const auto every = static_cast<std::size_t>(std::ceil(long_s / room_s));
    std::vector<Recording> kept;
    for (Recording& recording : recordings) {
        if (!is_long(recording)) {
            kept.push_back(std::move(recording));
            continue;
        }
        const auto rows = static_cast<std::size_t>(std::lround(piece_s / recording.tick_s));
        for (std::size_t first = 0; first < recording.rows.size(); first += every * rows)
            kept.push_back(piece(recording, first, std::min(first + rows, recording.rows.size())));
        notes.push_back(fmt::format("{}: of {:.0f} s every {}th minute is judged", recording.name,
                                    duration_s(recording), every));
    }
    return kept;
}

}  // namespace fidservo::diagnose
