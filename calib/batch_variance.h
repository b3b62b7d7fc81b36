// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The variance of an estimate whose errors are correlated over an unknown time.
//
// An estimate's error is the sum of influences, one for each piece of the data (a parameter's row of the
// inverse information matrix times the piece's score). Sums over batches of neighbouring pieces are
// independent once batches are long compared with the correlation time, and then the sum of their squares is
// the estimate's variance, whatever the errors' distribution: the cluster-robust "sandwich" of Liang and
// Zeger, Biometrika 73(1), 1986, with batches found as in Fishman, Grouping observations in digital
// simulation, Management Science 24(5), 1978.
#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::calib {

struct BatchVariance {
    double variance;
    double freedom;      ///< degrees of freedom of Student's distribution for intervals
    std::size_t pieces;  ///< number of pieces in a batch
};

/// Batches begin as single pieces and are doubled while neighbouring batches are correlated (one-sided test
/// of the first autocorrelation at 20 %, as too short batches do more harm than too long ones) and at least
/// eight batches would be left. Remaining correlation between neighbouring batches is included if it is
/// positive. The degrees of freedom follow from the batch sums s by Satterthwaite's rule, 3 (sum s^2)^2 / sum
/// s^4 for a normal distribution, but are at most the number of batches less one.
/// @param recordings  influences in the order of time, one series per recording; no batch spans two
/// recordings
/// @param fitted  number of parameters fitted to these data, for which the squares are corrected
BatchVariance batch_variance(std::span<const std::vector<double>> recordings, std::size_t fitted);

}  // namespace fidservo::calib
