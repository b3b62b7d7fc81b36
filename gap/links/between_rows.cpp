// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/between_rows.h"

#include "gap/numbers.h"

#include <algorithm>

namespace fidservo::gap {

namespace {

/// By how much the model exceeds a straight line between two rows.
double bend_lsb(const SmoothedReading& reading, const Moment& at) {
    const std::size_t bends = reading.model_bends_lsb.size() / reading.model_lsb.size();
    if (bends == 0 || !at.is_tick) return 0.0;
    const double parts = at.share * static_cast<double>(bends + 1);
    const auto part = std::min(static_cast<std::size_t>(parts), bends);
    const auto end_of = [&](std::size_t k) {
        return k == 0 || k > bends ? 0.0 : reading.model_bends_lsb[at.row * bends + k - 1];
    };
    const double share = parts - static_cast<double>(part);
    return end_of(part) + share * (end_of(part + 1) - end_of(part));
}

}  // namespace

Moment moment_at(const std::vector<double>& time_s, double tick_s, double at_s) {
    const std::size_t last = time_s.size() - 1;
    if (last == 0 || at_s <= time_s.front()) return {0, 0.0, true};
    if (at_s >= time_s.back()) return {last - 1, 1.0, true};
    auto row = std::min(static_cast<std::size_t>(at_s / tick_s), last - 1);
    if (time_s[row] > at_s || time_s[row + 1] <= at_s)
        row = static_cast<std::size_t>(std::ranges::upper_bound(time_s, at_s) - time_s.begin()) - 1;
    const double way_s = time_s[row + 1] - time_s[row];
    return {row, (at_s - time_s[row]) / way_s, way_s < most_steps_apart * tick_s};
}

std::size_t nearest_row(const std::vector<double>& time_s, double tick_s, double at_s) {
    const Moment at = moment_at(time_s, tick_s, at_s);
    return at.share < 0.5 ? at.row : at.row + 1;
}

double carriage_mm(const CarriagePath& path, const Moment& at, double tick_s) {
    const double t = at.share;
    if (t == 0.0) return path.position_mm[at.row];
    const double a = path.position_mm[at.row], b = path.position_mm[at.row + 1];
    if (!at.is_tick) return a + t * (b - a);
    const double va = tick_s * path.velocity_mm_per_s[at.row],
                 vb = tick_s * path.velocity_mm_per_s[at.row + 1];
    const double way = b - a;
    // Mathematics: the cubic with these ends and slopes.
    return a + t * (va + t * (3.0 * way - 2.0 * va - vb + t * (va + vb - 2.0 * way)));
}

double between(const std::vector<double>& values, const Moment& at) {
    const std::size_t i = at.row, last = values.size() - 1;
    if (at.share == 0.0) return values[i];
    const double b = values[i], c = values[i + 1];
    const double a = i == 0 ? b : values[i - 1], d = i + 2 > last ? c : values[i + 2];
    const double t = at.share;
    // Mathematics: the cubic through both ends, with the slopes between their neighbours.
    return b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
}

double reading_lsb(const SmoothedReading& reading, const Moment& at) {
    const std::vector<double>& model = reading.model_lsb;
    const double t = at.share;
    const double straight =
        t == 0.0 ? model[at.row] : model[at.row] + t * (model[at.row + 1] - model[at.row]);
    return straight + bend_lsb(reading, at) + between(reading.reading_lsb, at) - between(model, at);
}

}  // namespace fidservo::gap
