// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Intervals of a macro stage's parameters where the loss is not a parabola.
#include "calib/macro/macro_fit.h"

namespace fidservo::calib {

/// How many times farther than its standard error says one parameter may lie, on the side that is the wider
/// one: the profile likelihood's interval (everything else refitted at each value; Venzon,
/// Moolgavkar, A method for computing profile-likelihood-based confidence intervals, Applied Statistics
/// 37(1), 1988) over that of the standard error, at four standard errors. Where the loss is skew, the tails
/// are, more than the interval of 95 %; with this factor the standard error holds for both. The loss is
/// scaled to the parameter's own variance (Kent, Biometrika 69(1), 1982). From 1, where the loss is a
/// parabola or steeper, to 100, beyond which no end is looked for: a carriage that has not come near its
/// steady speed may tend to any faster one. Friction at its bound of 0 stays there: drive and friction that
/// grow together are no matter of skewness.
/// @param index  of macro_index; active in the fit. Of the time constant it is the time constant's own,
///               not its logarithm's.
double profile_widening(const MacroEstimator& estimator, const MacroFit& fit, int index);

}  // namespace fidservo::calib
