// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How likely a count is when the model predicts a place.
//
// A count c says that the noisy place lay within half a count of it, nothing more:
//
//     P(c | y) = Phi((c + 1/2 - y) / s) - Phi((c - 1/2 - y) / s)
//
// with noise of s counts before rounding. Where s is small, all places within the count are equally good, so
// a carriage at rest does not draw the fit to the middle of its count a thousand times a second; where s is
// large, -log P becomes the squares of a normal law. Gustafsson and Karlsson, Statistical results for system
// identification based on quantized observations, Automatica 45(12), 2009.

namespace fidservo::calib {

/// -log P and its derivatives with respect to the predicted place.
struct RoundingLoss {
    double value;
    double slope;      ///< per count
    double curvature;  ///< per count^2, never negative: P is log-concave
};

/// @param error_count  predicted place minus the count
/// @param noise_count  standard deviation before rounding, positive
RoundingLoss rounding_loss(double error_count, double noise_count);

}  // namespace fidservo::calib
