// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Least squares with coefficients that must not be negative:
//
//     minimise  w' G w / 2 - b' w   subject to  w >= 0,     G symmetric, positive definite.
//
// Block principal pivoting: L. F. Portugal, J. J. Judice, L. N. Vicente, "A comparison of block pivoting and
// interior-point algorithms for linear least squares problems with nonnegative variables", Mathematics of
// Computation 63, 1994. It finds the unique minimum exactly, usually with a dozen factorisations.

#include "core/result.h"

#include <span>
#include <vector>

namespace fidservo::calib {

/// @param matrix  G, n x n, row by row
/// @param rhs     b, n values
/// Fails with Reason::no_convergence if G is not positive definite to working precision.
Result<std::vector<double>> nonnegative_least_squares(std::span<const double> matrix,
                                                      std::span<const double> rhs);

}  // namespace fidservo::calib
