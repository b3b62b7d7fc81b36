// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A fiducial against the nominal grid.
//
// No instrument of this rig knows where a fiducial is on the plate better than the camera knows how far it is
// from the fiducials beside it: the encoder resolves 50 um, and the camera's own position comes from the very
// fiducials. So the reference is the neighbours that are seen together with it, at their nominal places. For
// each neighbour j, over the images that show both,
//     d_j = (p_k - p_j) measured - (p_k - p_j) nominal,
// and the placement error of k is the mean of the d_j. With one neighbour on either side an error of the
// camera's scale or of its rotation cancels. The spread of the d_j widens the uncertainty,
//     u^2 = (sum of their variances) / n^2 + (standard deviation of the d_j)^2 / n + J C J^T,
// where J C J^T is what the camera's calibration leaves of that mean (core/camera/camera_covariance.h),
// so that a displaced neighbour makes the placement undecidable rather than wrong.
#include "core/result.h"
#include "src/inspect/recipe/snapshot.h"

#include <string>
#include <vector>

#include <Eigen/Core>

namespace fidservo::inspect {

struct Placement {
    vision::Measured x_um, y_um;  ///< of the fiducial from its nominal place, against its neighbours
    std::vector<int> neighbours;  ///< ids, ascending
    Eigen::Vector2d disagreement_um{0.0, 0.0};  ///< between the neighbours that disagree most
};

/// @param snapshots  all views of the fiducial's site
/// Fails with no_tag if no neighbour was seen together with it.
Result<Placement> measure_placement(const std::vector<Snapshot>& snapshots, const Plate& nominal, int tag_id);

}  // namespace fidservo::inspect
