// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Finds a small printed shape near its nominal place by normalised correlation.
#include "core/result.h"
#include "vision/features/rest_image.h"

#include <functional>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

struct CoarseMatch {
    Eigen::Vector2d centre_px;  ///< to the nearest pixel
    double score;               ///< normalised correlation coefficient
    double contrast;            ///< 1 - inside / outside grey level
    double paper_grey;          ///< grey level around the shape
};

/// @param nominal_px   the shape's nominal centre
/// @param half_size_px of the box that holds the shape at any angle
/// @param coverage     how much of a pixel at (x, y) px from the shape's centre the shape covers, 0..1 Fails
/// with not_identifiable where the nominal shape is partly outside the image or two places match equally
/// well, and with feature_not_found where nothing of its form and contrast is within the margin.
Result<CoarseMatch> find_shape(const RestImage& image, const Eigen::Vector2d& nominal_px,
                               const Eigen::Vector2d& half_size_px,
                               const std::function<double(double, double)>& coverage,
                               const SearchOptions& options);

}  // namespace fidservo::vision
