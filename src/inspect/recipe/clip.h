// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The part of a straight piece that lies in a rectangle.
#include <optional>
#include <utility>

#include <Eigen/Core>

namespace fidservo::inspect {

struct Box {
    Eigen::Vector2d low_mm, high_mm;
};

/// Its two ends; empty if nothing of it lies inside. (Liang-Barsky.)
std::optional<std::pair<Eigen::Vector2d, Eigen::Vector2d>> clipped(const Eigen::Vector2d& from_mm,
                                                                   const Eigen::Vector2d& to_mm,
                                                                   const Box& box);

}  // namespace fidservo::inspect
