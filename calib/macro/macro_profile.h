// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Confidence intervals of a macro stage's parameters where the loss is not quadratic.
#include "calib/macro/macro_fit.h"

namespace fidservo::calib {

/// The factor by which the confidence interval of a parameter is wider than its standard error implies, on
/// the wider side: the interval by the profile likelihood (all other parameters refitted at each value;
/// Venzon, Moolgavkar, A method for computing profile-likelihood-based confidence intervals, Applied
/// Statistics 37(1), 1988), divided by that of the standard error, at a level of four standard errors.
/// Skewness of the loss affects the tails more than the 95 % interval; a standard error that is multiplied by
/// this factor is valid for both. The loss is scaled to the parameter's own variance (Kent, Biometrika 69(1),
/// 1982). The factor lies between 1, where the loss is quadratic or steeper, and 100, beyond which the end of
/// the interval is not searched for: data in which the carriage has not come near its steady speed are
/// compatible with any higher one. Friction at its bound of 0 is held there, since the possibility that drive
/// and friction increase together is not skewness.
/// @param index  of a parameter that is active in the fit. For the time constant the factor is that of the
/// time constant itself, not of its logarithm.
double profile_widening(const MacroEstimator& estimator, const MacroFit& fit, int index);

}  // namespace fidservo::calib
