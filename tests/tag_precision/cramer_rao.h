// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The lower bound on the variance of any unbiased estimator from one frame.
#include "tests/tag_precision/sensor.h"
#include "tests/tag_precision/tag_scene.h"

#include <vector>

#include <Eigen/Core>

namespace fidservo::precision {

struct UnknownPerspective {
    bool fitted = false;  ///< the tag's tilt about two axes is unknown, too
};

/// Derivatives of the mean grey picture with respect to the centre (u, v), then to the nuisances: rotation,
/// scale, width of the edges, gain, offset, two gradients of light, and the tilt if it is not known. Central
/// differences of exact pictures. Cover and glare are left out of account.
std::vector<cv::Mat1d> sensitivities(const TagScene& scene, const Sensor& sensor,
                                     const UnknownPerspective& perspective = {});

/// Fisher information of those unknowns in one frame, without the pixels that cover or glare change.
Eigen::MatrixXd fisher_information(const TagScene& scene, const Sensor& sensor,
                                   const UnknownPerspective& perspective = {});

/// Cramer-Rao bound on the covariance of the tag's centre, px^2.
///
///     F = sum over pixels of (dg/dp) (dg/dp)' / var(g),   C = (Fcc - Fcn Fnn^-1 Fnc)^-1
///
/// g is the mean grey level, c the centre, n the nuisances.
Eigen::Matrix2d position_bound(const TagScene& scene, const Sensor& sensor,
                               const UnknownPerspective& perspective = {});

}  // namespace fidservo::precision
