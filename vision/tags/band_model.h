// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the band of pixels along a tag's edges should look like, and how far the pixels are from it.
#include "vision/grey_noise.h"
#include "vision/tags/edge_band.h"
#include "vision/tags/tag_picture.h"

#include <vector>

#include <Eigen/Core>

namespace fidservo::vision {

/// All but the geometry: shape of the edges' profile and light. With x, y in the tag's frame, half a side 1,
/// and coverage by white m, the grey level is (black + (white - black) m) (1 + lx x + ly y + lr (x^2 + y^2)).
/// Parameters are in the order of kernel::LookColumn.
struct BandLook {
    double blur_x_px = 1.0;  ///< standard deviation across lines x = const; fitted as its logarithm
    double blur_y_px = 1.0;
    double spread_px = 0.0;    ///< by which black reaches farther out
    double skew_factor = 0.0;  ///< of f3, edge_profile.h: for light or display that is not linear
    double tail_factor = 0.0;  ///< of f4: for a blur that is not normal, and for the pixel's area
    double kink_factor = 0.0;  ///< of f5: like skew
    double white_grey = 0.0;
    double black_grey = 0.0;
    Eigen::Vector3d light = Eigen::Vector3d::Zero();
    double motion_x_px = 0.0;  ///< known, not fitted: stretch over which motion averages the profile
    double motion_y_px = 0.0;
};

/// Weighted least squares of one look at the band: geometry's parameters first, then the look's.
struct BandEquations {
    Eigen::MatrixXd normal;  ///< sum of w J J^T: the Fisher information
    Eigen::VectorXd right;   ///< sum of w J (pixel - model)
    double square_sum;       ///< of w (pixel - model)^2, in variances of the noise
};

/// @param residuals  is filled with those of the band's blocks
BandEquations evaluate_band(const EdgeBand& band, const TagPicture& picture, const BandLook& look,
                            const GreyNoise& noise, std::vector<kernel::Residuals>& residuals);

/// Brings equations up to date after some blocks' weights have changed: only those blocks are looked at
/// again.
void reweigh(BandEquations& equations, const EdgeBand& band, const std::vector<float>& weights_before,
             const TagPicture& picture, const BandLook& look, const GreyNoise& noise);

/// Sum over crossings of s s^T, s the sum of w J (pixel - model) over a crossing's pixels, times n / (n - 1)
/// for n crossings: the middle of a sandwich estimate that allows for what a crossing's pixels have in
/// common. Source: Cameron and Miller, A practitioner's guide to cluster-robust inference, 2015, eq. 11
/// and 12.
Eigen::MatrixXd band_scatter(const EdgeBand& band, const TagPicture& picture, const BandLook& look,
                             const GreyNoise& noise);

}  // namespace fidservo::vision
