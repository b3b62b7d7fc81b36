// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/tally/reliability.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::selfcheck {

Reliability reliability_of(std::vector<Claim> claims, std::size_t most_bins, std::size_t least_claims) {
    Reliability result;
    std::ranges::stable_sort(claims, {}, &Claim::probability);
    const std::size_t count = claims.size();
    if (count == 0) {
        result.expected_error = result.brier = std::numeric_limits<double>::quiet_NaN();
        return result;
    }
    const std::size_t bins = std::clamp<std::size_t>(count / least_claims, 1, most_bins);
    for (std::size_t bin = 0; bin < bins; ++bin) {
        const std::size_t begin = bin * count / bins, end = (bin + 1) * count / bins;
        const auto size = static_cast<double>(end - begin);
        ReliabilityBin sums{0.0, 0.0, end - begin};
        for (std::size_t k = begin; k < end; ++k) {
            const double truth = claims[k].came_true ? 1.0 : 0.0;
            sums.mean_probability += claims[k].probability / size;
            sums.share_true += truth / size;
            result.brier += std::pow(claims[k].probability - truth, 2) / static_cast<double>(count);
        }
        result.expected_error +=
            size / static_cast<double>(count) * std::abs(sums.mean_probability - sums.share_true);
        result.bins.push_back(sums);
    }
    return result;
}

}  // namespace fidservo::selfcheck
