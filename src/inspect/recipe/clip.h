// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The part of a line segment inside a rectangle.
#include <optional>
#include <utility>

#include <Eigen/Core>

namespace fidservo::inspect {

struct Box {
    Eigen::Vector2d low_mm, high_mm;
};

/// Its two ends; empty if no part of the segment is inside. (Liang-Barsky.)
std::optional<std::pair<Eigen::Vector2d, Eigen::Vector2d>> clipped(const Eigen::Vector2d& from_mm,
                                                                   const Eigen::Vector2d& to_mm,
                                                                   const Box& box);

}  // namespace fidservo::inspect
