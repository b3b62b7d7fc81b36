// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/loop_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fidservo::control {

namespace {

constexpr TimeNs fine_ns = 1000;
constexpr TimeNs coarse_ns = static_cast<TimeNs>(LatenessHistogram::fine_bins) * fine_ns;

}  // namespace

std::size_t LatenessHistogram::bin_of(TimeNs late_ns) noexcept {
    if (late_ns < coarse_ns) return static_cast<std::size_t>(std::max<TimeNs>(late_ns, 0) / fine_ns);
    std::size_t coarse = 0;
    while (coarse + 1 < coarse_bins && late_ns >= coarse_ns << (coarse + 1)) ++coarse;
    return fine_bins + coarse;
}

TimeNs LatenessHistogram::end_ns(std::size_t bin) noexcept {
    if (bin < fine_bins) return static_cast<TimeNs>(bin + 1) * fine_ns;
    return coarse_ns << (bin - fine_bins + 1);
}

std::uint64_t LatenessHistogram::total() const {
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

TimeNs LatenessHistogram::quantile_ns(double share) const {
    const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(total())));
    std::uint64_t so_far = 0;
    for (std::size_t bin = 0; bin < counts.size(); ++bin) {
        so_far += counts[bin];
        if (counts[bin] > 0 && so_far >= wanted) return std::min(end_ns(bin), worst_ns);
    }
    return worst_ns;
}

}  // namespace fidservo::control
