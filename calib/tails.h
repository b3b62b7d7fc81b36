// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Tail probabilities of Fisher's and Student's distributions, from the incomplete beta function.

namespace fidservo::calib {

/// P(F > ratio) for a ratio of mean squares with `above` and `below` degrees of freedom, which may be
/// infinite.
/// @param ratio  at least 0. Demands positive degrees of freedom.
double mean_square_ratio_tail(double ratio, double above, double below);

/// t with P(|T| > t) = both_tails for Student's distribution; `freedom` may be infinite.
/// @param both_tails  in (0, 1). Demands positive degrees of freedom.
double student_bound(double freedom, double both_tails);

/// Half the width of a 95 % interval in standard errors, for the normal and for Student's distribution.
inline constexpr double normal_95 = 1.96;
double student_95(double freedom);

}  // namespace fidservo::calib
