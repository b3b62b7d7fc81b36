// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Tails of the laws by which estimates of unknown variance are judged, from the incomplete beta function.

namespace fidservo::calib {

/// P(F > ratio) for a ratio of mean squares with such degrees of freedom; either may be infinite.
/// @param ratio  at least 0. Demands positive degrees of freedom.
double mean_square_ratio_tail(double ratio, double above, double below);

/// t with P(|T| > t) = both_tails for Student's law; `freedom` may be infinite.
/// @param both_tails  in (0, 1). Demands positive degrees of freedom.
double student_bound(double freedom, double both_tails);

/// Half the width of an interval of 95 % in standard errors: of a normal law, and of Student's.
inline constexpr double normal_95 = 1.96;
double student_95(double freedom);

}  // namespace fidservo::calib
