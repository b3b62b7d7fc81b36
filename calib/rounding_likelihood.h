// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The likelihood of an encoder's count for a predicted position.
//
// A count c means that the noisy position was within half a count of it:
//
//     P(c | y) = Phi((c + 1/2 - y) / s) - Phi((c - 1/2 - y) / s)
//
// with noise of s counts before rounding. Where s is small, all positions within the count are equally
// likely, so that the many readings of a carriage at rest do not pull the fit to the middle of its count;
// where s is large, -log P becomes the square of a normal distribution. Gustafsson and Karlsson, Statistical
// results for system identification based on quantized observations, Automatica 45(12), 2009.

namespace fidservo::calib {

/// -log P and its derivatives with respect to the predicted place.
struct RoundingLoss {
    double value;
    double slope;      ///< per count
    double curvature;  ///< per count^2, never negative: P is log-concave
};

/// @param error_count  predicted position minus the count
/// @param noise_count  standard deviation before rounding, positive
RoundingLoss rounding_loss(double error_count, double noise_count);

/// Its value alone, at less than half the cost.
double rounding_loss_value(double error_count, double noise_count);

}  // namespace fidservo::calib
