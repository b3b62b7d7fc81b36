// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How alike two signals are at every lag between them, and the lags at which they are most alike.
#include <cstddef>
#include <vector>

namespace fidservo::imports {

/// Pearson's correlation r of y[i] and x[i + lag], at each lag that leaves half of the shorter signal in
/// common; 0 where one of the two does not move.
struct LagScan {
    std::ptrdiff_t first = 0;   ///< lag of correlation[0]
    std::ptrdiff_t common = 0;  ///< samples that any lag has in common at least
    std::vector<double> correlation;
};

LagScan scan_lags(const std::vector<double>& y, const std::vector<double>& x);

/// A maximum of |r|.
struct LagPeak {
    std::size_t at = 0;  ///< index in LagScan::correlation
    /// How far |r| falls at least on the way to any higher maximum (topological persistence); all of its
    /// height for the highest one.
    double prominence = 0.0;
};

/// The maxima of |r|, the highest first.
std::vector<LagPeak> peaks_of(const LagScan& scan);

/// The number of lags around a maximum over which |r| stays above half of its height there.
std::size_t width_at_half_height(const LagScan& scan, std::size_t peak);

}  // namespace fidservo::imports
