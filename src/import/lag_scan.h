// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The correlation of two signals as a function of the lag between them, and its maxima.
#include <cstddef>
#include <vector>

namespace fidservo::imports {

/// Pearson's correlation r of y[i] and x[i + lag], at each lag at which the signals overlap by at least half
/// of the shorter one; 0 where one of them is constant.
struct LagScan {
    std::ptrdiff_t first = 0;   ///< lag of correlation[0]
    std::ptrdiff_t common = 0;  ///< least number of overlapping samples at any lag
    std::vector<double> correlation;
};

LagScan scan_lags(const std::vector<double>& y, const std::vector<double>& x);

/// A maximum of |r|.
struct LagPeak {
    std::size_t at = 0;  ///< index in LagScan::correlation
    /// The least drop of |r| on the way to any higher maximum (topological persistence); for the highest
    /// maximum, its height.
    double prominence = 0.0;
};

/// The maxima of |r|, the highest first.
std::vector<LagPeak> peaks_of(const LagScan& scan);

/// The number of lags around a maximum over which |r| stays above half of its height there.
std::size_t width_at_half_height(const LagScan& scan, std::size_t peak);

}  // namespace fidservo::imports
