// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The model of the grey levels in the band of pixels along a tag's edges, and its least squares equations.
#include "vision/grey_noise.h"
#include "vision/tags/edge_band.h"
#include "vision/tags/tag_picture.h"

#include <vector>

#include <Eigen/Core>

namespace fidservo::vision {

/// The parameters besides the geometry: the shape of the edges' profile, and the light. With x, y in the
/// tag's frame in units of half a side, and the coverage by white m, the grey level is (black + (white -
/// black) m) (1 + lx x + ly y + lr (x^2 + y^2)). Parameters are in the order of kernel::LookColumn.
struct BandLook {
    /// Standard deviation of the blur across lines x = const; fitted as its logarithm.
    double blur_x_px = 1.0;
    double blur_y_px = 1.0;
    double spread_px = 0.0;  ///< distance by which black edges extend outwards
    /// Coefficient of f3 (edge_profile.h), for a nonlinear response of camera or display.
    double skew_factor = 0.0;
    /// Coefficient of f4, for a blur that is not Gaussian, and for the pixel's area.
    double tail_factor = 0.0;
    double kink_factor = 0.0;  ///< coefficient of f5, for the same reason as the skew
    double white_grey = 0.0;
    double black_grey = 0.0;
    Eigen::Vector3d light = Eigen::Vector3d::Zero();
    double motion_x_px = 0.0;  ///< known, not fitted: length over which motion averages the profile
    double motion_y_px = 0.0;
};

/// The weighted least squares equations of the band: the geometry's parameters first, then the look's.
struct BandEquations {
    Eigen::MatrixXd normal;  ///< sum of w J J^T: the Fisher information
    Eigen::VectorXd right;   ///< sum of w J^T (pixel - model)
    double square_sum;       ///< sum of w (pixel - model)^2, in variances of the noise
};

/// @param residuals  receives those of the band's blocks
BandEquations evaluate_band(const EdgeBand& band, const TagPicture& picture, const BandLook& look,
                            const GreyNoise& noise, std::vector<kernel::Residuals>& residuals);

/// Updates the equations after the weights of some blocks have changed; only those blocks are evaluated
/// again.
void reweigh(BandEquations& equations, const EdgeBand& band, const std::vector<float>& weights_before,
             const TagPicture& picture, const BandLook& look, const GreyNoise& noise);

/// Sum over crossings of s s^T, s the sum of w J (pixel - model) over a crossing's pixels, times n / (n - 1)
/// for n crossings: the middle factor of a sandwich estimate, clustered by crossing, that allows for
/// correlated errors of a crossing's pixels. Source: Cameron and Miller, A practitioner's guide to
/// cluster-robust inference, 2015, eq. 11 and 12.
Eigen::MatrixXd band_scatter(const EdgeBand& band, const TagPicture& picture, const BandLook& look,
                             const GreyNoise& noise);

}  // namespace fidservo::vision
