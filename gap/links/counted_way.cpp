// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/counted_way.h"

#include "gap/evidence/windows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::gap {

namespace {

/// Number of turns up to a row, the last of which begins the motion that leads there. 0 before the first
/// reading.
std::size_t turns_before(const CountedWay& way, std::size_t row) {
    const auto behind = std::ranges::upper_bound(way.turns, row, {}, &Turn::row);
    return static_cast<std::size_t>(behind - way.turns.begin());
}

/// A distance that reduces the memory of earlier motion to one part in a million.
double forgetting_way_mm(const plant::MacroAxis& axis) {
    constexpr double lengths = 14.0;
    const double bristles_mm = axis.has_bristles ? lengths * axis.parameters.friction.bristle_mm : 0.0;
    return std::max(bristles_mm, axis.parameters.play_mm);
}

}  // namespace

CountedWay counted_way(const std::vector<double>& reading_count) {
    CountedWay way;
    way.place_count.reserve(reading_count.size());
    double place = std::numeric_limits<double>::quiet_NaN(), direction = 0.0;
    for (std::size_t row = 0; row < reading_count.size(); ++row) {
        const double count = reading_count[row];
        if (std::isfinite(count)) {
            const double next = std::isnan(place) ? count : std::clamp(place, count - 0.5, count + 0.5);
            const bool begins = way.turns.empty();
            if (begins || (next != place && std::copysign(1.0, next - place) != direction)) {
                way.turns.push_back({row, begins ? count : place});
                direction = begins ? 0.0 : std::copysign(1.0, next - place);
            }
            place = next;
        }
        way.place_count.push_back(place);
    }
    return way;
}

bool remembers(const plant::MacroAxis& axis) {
    return axis.has_bristles || axis.parameters.play_mm != 0.0 || axis.parameters.formulas.remember();
}

double covered_count(const CountedWay& way, std::size_t row) {
    double covered = 0.0;
    const std::size_t turns = turns_before(way, row);
    for (std::size_t k = 0; k < turns; ++k)
        covered += std::abs((k + 1 < turns ? way.turns[k + 1].place_count : way.place_count[row]) -
                            way.turns[k].place_count);
    return covered;
}

plant::MechanismState remembered(const CountedWay& way, const plant::MacroAxis& axis, double mm_per_count,
                                 std::size_t row) {
    plant::MechanismState mechanism;
    if (!remembers(axis)) return mechanism;
    const std::size_t turns = turns_before(way, row);
    for (std::size_t k = 0; k < turns; ++k) {
        const double end = k + 1 < turns ? way.turns[k + 1].place_count : way.place_count[row];
        const double way_mm = mm_per_count * (end - way.turns[k].place_count);
        if (way_mm == 0.0) continue;
        const double direction = std::copysign(1.0, way_mm);
        mechanism.play_mm = -direction * 0.5 * axis.parameters.play_mm;
        const plant::Friction& friction = axis.parameters.friction;
        if (axis.has_bristles)
            mechanism.bristle_bend = plant::bristle_bend(friction, mechanism.bristle_bend, way_mm, direction,
                                                         friction.coulomb_V, friction.coulomb_V)
                                         .bend;
    }
    return mechanism;
}

bool is_remembered(const CountedWay& way, const plant::MacroAxis& axis, double mm_per_count,
                   std::size_t row) {
    if (!remembers(axis)) return true;
    if (axis.parameters.formulas.remember()) return false;
    const std::size_t turns = turns_before(way, row), ahead = row + lead_rows(axis.tick_s);
    if (turns == 0 || ahead >= way.place_count.size() || turns_before(way, ahead) != turns) return false;
    const double covered = way.place_count[row] - way.turns[turns - 1].place_count,
                 next = way.place_count[ahead] - way.place_count[row];
    return next != 0.0 && std::abs(mm_per_count * covered) > forgetting_way_mm(axis);
}

}  // namespace fidservo::gap
