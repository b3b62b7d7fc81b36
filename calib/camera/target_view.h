// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Views of a target: printed tags at known places, and where they were seen.
#include "core/plate.h"
#include "vision/tags/tag_refinement.h"

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace fidservo::calib {

/// A tag in a view. Lengths may be in any unit; that of `printed` is the unit of all results.
struct TagSight {
    PlateTag printed;         ///< its place on the target
    vision::RefinedTag seen;  ///< its corners in the image
};

/// The measured part of a target in one image.
struct TargetView {
    std::string name;            ///< the image's file, for messages
    std::vector<TagSight> tags;  ///< those that were measured
};

/// Weights of a tag's corners: W with W C W^T = I in the directions in which the covariance C is finite. A
/// tag that was refined with a calibrated camera has four such directions (position, rotation, scale); in the
/// other four nothing was measured, and W is zero.
struct CornerWeights {
    Eigen::Matrix<double, 8, 8> whiten;  ///< rows beyond the rank are zero
    int rank;                            ///< number of rows that count
};

/// @param extra_std_px  standard deviation added in quadrature in every measured direction
CornerWeights corner_weights(const vision::CornerCovariance& covariance_px2, double extra_std_px);

}  // namespace fidservo::calib
