#pragma once
// The best that any unbiased estimator can do with one frame.
#include "tests/tag_precision/sensor.h"
#include "tests/tag_precision/tag_scene.h"

#include <Eigen/Core>

namespace fidservo::precision {

struct UnknownPerspective {
    bool fitted = false;  ///< two more unknowns: the tag's tilt about two axes
};

/// Cramer-Rao bound on the covariance of the tag's centre, px^2.
///
///     F = sum over pixels of (dg/dp) (dg/dp)' / var(g),   C = (Fpp - Fpn Fnn^-1 Fnp)^-1
///
/// g is the mean grey level, p the centre, n the nuisances: rotation, scale, gain, offset, two gradients of
/// light, width of the edges, and the tilt if it is not known. Derivatives with respect to geometry and width
/// are central differences of exact pictures. Pixels that cover or glare change are left out.
Eigen::Matrix2d position_bound(const TagScene& scene, const Sensor& sensor,
                               const UnknownPerspective& perspective = {});

}  // namespace fidservo::precision
