// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Confidence intervals of a macro stage's parameters where the loss is not quadratic.
#include "calib/macro/macro_fit.h"

namespace fidservo::calib {

/// The factor by which one parameter's interval is wider than by its standard error, on its wider side: the
/// profile likelihood's interval (all other parameters refitted at each value; Venzon, Moolgavkar, A method
/// for computing profile-likelihood-based confidence intervals, Applied Statistics 37(1), 1988) over that of
/// the standard error, at four standard errors. A skew loss affects the tails more than the 95 % interval;
/// with this factor the standard error is valid for both. The loss is scaled to the parameter's own variance
/// (Kent, Biometrika 69(1), 1982). The factor lies between 1, where the loss is quadratic or steeper, and
/// 100, beyond which the interval is not searched for an end: a carriage that has not come near its steady
/// speed is compatible with any higher one. Friction at its bound of 0 is kept there: that drive and friction
/// may grow together is not skewness.
/// @param index  of a parameter that is active in the fit. For the time constant the factor is that of the
/// time constant itself, not of its logarithm.
double profile_widening(const MacroEstimator& estimator, const MacroFit& fit, int index);

}  // namespace fidservo::calib
