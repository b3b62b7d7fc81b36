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
    PlateTag printed;         ///< as the target has it
    vision::RefinedTag seen;  ///< as the image shows it
};

/// What one image shows of the target.
struct TargetView {
    std::string name;            ///< for people: the image's file
    std::vector<TagSight> tags;  ///< those that were measured
};

/// Weights of a tag's corners by what was measured of them: W with W C W^T = I on the directions that C
/// knows. A tag refined with a calibrated camera has four of them (place, rotation, scale); along the other
/// directions nothing was measured, and W is zero there.
struct CornerWeights {
    Eigen::Matrix<double, 8, 8> whiten;  ///< rows beyond the rank are zero
    int rank;                            ///< how many rows count
};

/// @param extra_std_px  added in squares to every measured direction
CornerWeights corner_weights(const vision::CornerCovariance& covariance_px2, double extra_std_px);

}  // namespace fidservo::calib
