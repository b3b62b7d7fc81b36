// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Outlines of features, for drawing over an image.
#include "core/plate.h"
#include "vision/features/rest_image.h"

#include <vector>

namespace fidservo::inspect {

using Outline = std::vector<Eigen::Vector2d>;  ///< px

Outline circle(const vision::RestImage& image, const Eigen::Vector2d& centre_mm, double diameter_mm);
Outline rectangle(const vision::RestImage& image, const Eigen::Vector2d& centre_mm,
                  const Eigen::Vector2d& size_mm, double angle_rad);
/// The nominal outline of a dot, pad, line or scratch.
Outline outline_of(const vision::RestImage& image, const Feature& feature);

}  // namespace fidservo::inspect
