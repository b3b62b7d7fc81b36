// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where a value stops being chance.

namespace fidservo::calib {

/// z with P(Z > z) = tail for a standard normal Z. @param tail  in (0, 0.5]
double normal_bound(double tail);

/// Bound that a chi-square variable exceeds with probability `tail`, by Wilson and Hilferty's cube root
/// (Proc. National Academy of Sciences 17, 1931): good to 1 % from 3 degrees of freedom on for tails down to
/// 1e-4.
double chi_square_bound(double freedom, double tail);

/// Bound that the ratio of two mean squares with such degrees of freedom exceeds with probability `tail`, by
/// Paulson's approximation (Annals of Mathematical Statistics 13, 1942): good to some per cent where `below`
/// is at least 4 and tails are not below 1e-3; further out it is too high, exceeded three times of four that
/// it ought to be at 6e-5 with 1 and 20 degrees of freedom.
double mean_square_ratio_bound(double above, double below, double tail);

}  // namespace fidservo::calib
