#include "gap/tag_sight.h"

#include <algorithm>
#include <cmath>

namespace fidservo::gap {

TagSight sight_of(const Evidence& evidence, std::size_t run, std::size_t detection) {
    constexpr std::size_t look_back = 20;
    const TagSighting& tag = evidence.sighting(run, detection);
    const Course& course = evidence.course(run);
    const std::vector<StageRow>& rows = evidence.recordings()[run].rows;
    const TimeNs start_ns = rows.front().time_ns;
    const auto after = std::ranges::upper_bound(
        rows, tag.stamp_s, {}, [&](const StageRow& row) { return seconds(row.time_ns - start_ns); });
    const auto next = static_cast<std::size_t>(after - rows.begin());
    const std::size_t row = next > 0 ? next - 1 : 0, before = row > look_back ? row - look_back : 0;
    TagSight found{run, tag, course.position_mm[row], course.velocity_mm_per_s[row], 0.0, tag.stamp_s};
    if (!course.contraction_mm.empty() && std::isfinite(course.contraction_mm[row])) {
        found.contraction_mm = course.contraction_mm[row];
        if (row > before)
            found.velocity_mm_per_s += (course.contraction_mm[row] - course.contraction_mm[before]) /
                                       (evidence.rig().tick_s * static_cast<double>(row - before));
    }
    return found;
}

}  // namespace fidservo::gap
