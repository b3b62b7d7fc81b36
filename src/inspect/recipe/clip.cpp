// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/recipe/clip.h"

#include <algorithm>

namespace fidservo::inspect {

std::optional<std::pair<Eigen::Vector2d, Eigen::Vector2d>> clipped(const Eigen::Vector2d& from_mm,
                                                                   const Eigen::Vector2d& to_mm,
                                                                   const Box& box) {
    double from = 0.0, to = 1.0;
    const Eigen::Vector2d along = to_mm - from_mm;
    for (int axis = 0; axis < 2; ++axis) {
        if (along[axis] == 0.0) {
            if (from_mm[axis] < box.low_mm[axis] || from_mm[axis] > box.high_mm[axis]) return std::nullopt;
            continue;
        }
        const double a = (box.low_mm[axis] - from_mm[axis]) / along[axis];
        const double b = (box.high_mm[axis] - from_mm[axis]) / along[axis];
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }
    if (from >= to) return std::nullopt;
    return std::pair<Eigen::Vector2d, Eigen::Vector2d>(from_mm + from * along, from_mm + to * along);
}

}  // namespace fidservo::inspect
