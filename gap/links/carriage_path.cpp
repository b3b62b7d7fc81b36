// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/carriage_path.h"

#include "gap/numbers.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::gap {

namespace {

/// Interpolates unknown values linearly between known ones; before the first and after the last known value
/// it holds that. 0 where none is known.
void bridge(std::vector<double>& values) {
    const auto end = values.end();
    auto before = end;
    for (auto from = values.begin(); from != end;) {
        const auto after = std::find_if(from, end, [](double value) { return std::isfinite(value); });
        const double last = after != end ? *after : before != end ? *before : 0.0;
        const double first = before != end ? *before : last;
        const auto steps = static_cast<double>(after - from + 1);
        for (auto value = from; value != after; ++value)
            *value = std::lerp(first, last, static_cast<double>(value - from + 1) / steps);
        if (after == end) return;
        before = after;
        from = after + 1;
    }
}

}  // namespace

CarriagePath unknown_path(std::size_t rows, Followed followed) {
    const auto unknown = [rows] {
        return std::vector<double>(rows, std::numeric_limits<double>::quiet_NaN());
    };
    if (followed == Followed::places) return {unknown(), {}, {}, {}, {}};
    return {unknown(), unknown(), unknown(), unknown(), unknown()};
}

double position_mm(const plant::Encoder& encoder, double reading_count) {
    constexpr int enough = 8;
    double place_mm = reading_count * encoder.resolution_mm;
    if (encoder.is_straight()) return place_mm;
    for (int step = 0; step < enough; ++step) {
        const double on_mm = encoder.resolution_mm * (reading_count - mean_reading_count(encoder, place_mm));
        place_mm += on_mm;
        if (std::abs(on_mm) < next_to_nothing) break;
    }
    return place_mm;
}

double mm_per_count(const plant::Encoder& encoder, double position_mm) {
    return 1.0 / counts_per_mm(encoder, position_mm);
}

void pull_to_counts(const plant::Encoder& encoder, const CarriageRun& run, const WindowRows& window,
                    CarriagePath& lead, CarriagePath& path) {
    const std::size_t piece = window.first - window.lead;
    const std::size_t pieces = std::max<std::size_t>(1, (window.end - window.lead) / piece);
    const auto place_mm = [&](std::size_t k) -> double& {
        return k < window.first ? lead.position_mm[k - window.lead] : path.position_mm[k];
    };
    std::vector<double> pull_count(pieces);
    for (std::size_t i = 0; i < pieces; ++i) {
        const std::size_t from = window.lead + i * piece;
        const std::size_t to = i + 1 == pieces ? window.end : from + piece;
        double sum = 0.0;
        for (std::size_t k = from; k < to; ++k)
            sum += mean_reading_count(encoder, place_mm(k)) - run.reading_count[k];
        pull_count[i] = beyond_rounding(sum / static_cast<double>(to - from));
    }
    if (std::ranges::all_of(pull_count, [](double pull) { return pull == 0.0; })) return;
    for (std::size_t k = window.lead; k < window.end; ++k) {
        const double at = (static_cast<double>(k - window.lead) + 0.5) / static_cast<double>(piece) - 0.5;
        const double within = std::clamp(at, 0.0, static_cast<double>(pieces - 1));
        const auto i = std::min(static_cast<std::size_t>(within), pieces - 1);
        const double share = within - static_cast<double>(i);
        const double pull = pull_count[i] + share * (pull_count[std::min(i + 1, pieces - 1)] - pull_count[i]);
        place_mm(k) -= mm_per_count(encoder, place_mm(k)) * pull;
    }
}

void fade_in(const WindowRows& window, const CarriagePath& lead, CarriagePath& path) {
    const auto fade = [&](std::vector<double>& before, const std::vector<double>& next) {
        for (std::size_t i = 0; i < next.size(); ++i) {
            double& value = before[window.lead + i];
            const double share = std::isfinite(value)
                                     ? (static_cast<double>(i) + 0.5) / static_cast<double>(next.size())
                                     : 1.0;
            value = share == 1.0 ? next[i] : value + share * (next[i] - value);
        }
    };
    std::ranges::copy(lead.position_mm, path.entering_mm.begin() + static_cast<std::ptrdiff_t>(window.lead));
    fade(path.position_mm, lead.position_mm);
    fade(path.velocity_mm_per_s, lead.velocity_mm_per_s);
    fade(path.acceleration_mm_per_s2, lead.acceleration_mm_per_s2);
    fade(path.jerk_mm_per_s3, lead.jerk_mm_per_s3);
}

void fill(const plant::Encoder& encoder, const CarriageRun& run, CarriagePath& path) {
    const std::size_t rows = path.position_mm.size();
    for (std::size_t k = 0; k < rows; ++k)
        if (!std::isfinite(path.position_mm[k]) && std::isfinite(run.reading_count[k]))
            path.position_mm[k] = position_mm(encoder, run.reading_count[k]);
    bridge(path.position_mm);
    constexpr std::size_t reach = 10;
    for (std::size_t k = 0; k < rows; ++k) {
        if (std::isfinite(path.velocity_mm_per_s[k])) continue;
        const std::size_t from = k < reach ? 0 : k - reach, to = std::min(k + reach, rows - 1);
        const double way_mm = path.position_mm[to] - path.position_mm[from];
        path.velocity_mm_per_s[k] = to > from ? way_mm / (static_cast<double>(to - from) * run.tick_s) : 0.0;
    }
    for (std::size_t k = 0; k < rows; ++k) {
        if (std::isfinite(path.acceleration_mm_per_s2[k])) continue;
        const std::size_t next = std::min(k + 1, rows - 1);
        path.acceleration_mm_per_s2[k] =
            (path.velocity_mm_per_s[next] - path.velocity_mm_per_s[k]) / run.tick_s;
        path.jerk_mm_per_s3[k] = 0.0;
    }
}

}  // namespace fidservo::gap
