// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The variance of an estimate whose errors are correlated over an unknown time.
//
// An estimate is off by the sum of its influences, a piece of the data each (a parameter's row of the inverse
// information times the piece's score). Sums over batches of neighbouring pieces are independent once batches
// are long against the correlation, and then the sum of their squares is the estimate's variance, whatever
// the errors' law: the cluster-robust "sandwich" of Liang and Zeger, Biometrika 73(1), 1986, with batches
// found as Fishman does, Grouping observations in digital simulation, Management Science 24(5), 1978.
#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::calib {

struct BatchVariance {
    double variance;
    double freedom;      ///< of Student's law for intervals
    std::size_t pieces;  ///< a batch
};

/// Batches begin as single pieces and are doubled while neighbouring batches are correlated (one-sided test
/// of the first autocorrelation, 20 %: a batch too short costs more than one too long) and eight or more
/// would be left. What correlation is left between neighbours is counted if it is positive. Degrees of
/// freedom: those of the batches that matter, by Satterthwaite's rule on their squares, 3 (sum s^2)^2 / sum
/// s^4 under a normal law, at most their number less one.
/// @param recordings  influences in the order of time, a series a recording; no batch spans two
/// @param fitted  parameters fitted to these data, by which the squares are too small
BatchVariance batch_variance(std::span<const std::vector<double>> recordings, std::size_t fitted);

}  // namespace fidservo::calib
