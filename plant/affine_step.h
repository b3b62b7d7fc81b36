// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The exact step of a motion whose forces are linear between events, x' = A x + b:
//
//     x(h) = x + G x',   G = integral from 0 to h of exp(A s) ds
#include <array>
#include <cstddef>

namespace fidservo::plant {

/// A square matrix, row by row.
template <std::size_t size>
using SquareMatrix = std::array<std::array<double, size>, size>;

/// G for a duration h in s and an A in 1/s, of 2 or 4 states.
template <std::size_t size>
SquareMatrix<size> affine_step(const SquareMatrix<size>& rates, double duration_s);

}  // namespace fidservo::plant
