// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Critical values: bounds that chance exceeds with a given probability.

namespace fidservo::calib {

/// z with P(Z > z) = tail for a standard normal Z. @param tail  in (0, 0.5]
double normal_bound(double tail);

/// Bound that a chi-square variable exceeds with probability `tail`, by Wilson and Hilferty's cube root
/// (Proc. National Academy of Sciences 17, 1931): accurate to 1 % from 3 degrees of freedom on, for tails
/// down to 1e-4.
double chi_square_bound(double freedom, double tail);

/// Bound that the ratio of two mean squares with `above` and `below` degrees of freedom exceeds with
/// probability `tail`, by Paulson's approximation (Annals of Mathematical Statistics 13, 1942): accurate to
/// some per cent where `below` is at least 4 and tails are not below 1e-3. Further out it is too high: at a
/// tail of 6e-5 with 1 and 20 degrees of freedom it is exceeded with three quarters of that probability.
double mean_square_ratio_bound(double above, double below, double tail);

}  // namespace fidservo::calib
