// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/tag_sight.h"

#include "core/rig.h"
#include "gap/evidence/windows.h"
#include "gap/numbers.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace fidservo::gap {
namespace {

/// Whether carriage and platform have moved by no more than this, on average and in a row, up to a row.
bool has_stood(const Course& course, double tick_s, std::size_t row) {
    constexpr double least_mm_per_s = 0.5;
    const auto rows = static_cast<std::size_t>(lead_s / tick_s);
    if (row < rows) return false;
    const std::span recent = std::span(course.velocity_mm_per_s).subspan(row - rows, rows + 1);
    if (!std::ranges::all_of(recent, [](float velocity) { return std::abs(velocity) < least_mm_per_s; }))
        return false;
    return course.contraction_mm.empty() ||
           std::abs(course.contraction_mm[row] - course.contraction_mm[row - rows]) < least_mm_per_s * lead_s;
}

}  // namespace

TagSight sight_of(const Evidence& evidence, std::size_t run, std::size_t detection) {
    const TagSighting& tag = evidence.sighting(run, detection);
    const Course& course = evidence.course(run);
    const std::vector<StageRow>& rows = evidence.recordings()[run].rows;
    const TimeNs start_ns = rows.front().time_ns;
    const auto after = std::ranges::upper_bound(
        rows, tag.stamp_s, {}, [&](const StageRow& row) { return seconds(row.time_ns - start_ns); });
    const auto next = static_cast<std::size_t>(after - rows.begin());
    const std::size_t row = next > 0 ? next - 1 : 0, before = row > glance_rows ? row - glance_rows : 0;
    TagSight found{run,
                   tag,
                   course.position_mm[row],
                   course.velocity_mm_per_s[row],
                   0.0,
                   tag.stamp_s,
                   has_stood(course, evidence.rig().tick_s, row)};
    if (!course.contraction_mm.empty() && std::isfinite(course.contraction_mm[row])) {
        found.contraction_mm = course.contraction_mm[row];
        if (row > before)
            found.velocity_mm_per_s += (course.contraction_mm[row] - course.contraction_mm[before]) /
                                       (evidence.rig().tick_s * static_cast<double>(row - before));
    }
    return found;
}

}  // namespace fidservo::gap
