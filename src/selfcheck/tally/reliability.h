// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether stated probabilities are calibrated.
#include <cstddef>
#include <vector>

namespace fidservo::selfcheck {

/// A claim with its probability, and whether it was true.
struct Claim {
    double probability;
    bool came_true;
};

struct ReliabilityBin {
    double mean_probability;
    double share_true;
    std::size_t claims;
};

/// Calibration statistics; NaN without claims.
struct Reliability {
    std::vector<ReliabilityBin> bins;  ///< by probability, ascending
    double expected_error = 0.0;  ///< mean over claims of |mean probability - fraction true| of their bin
    double brier = 0.0;           ///< mean of (probability - 1 or 0)^2
};

/// @param most_bins  the largest number of bins, all with as many claims; there are fewer if a bin would have
/// less than least_claims Source: Naeini, Cooper, Hauskrecht, AAAI 2015 (expected calibration error); Brier,
/// Mon. Weather Rev. 78 (1950).
Reliability reliability_of(std::vector<Claim> claims, std::size_t most_bins = 10,
                           std::size_t least_claims = 20);

}  // namespace fidservo::selfcheck
