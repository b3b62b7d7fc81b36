// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the times of single frames are told: median, 99th percentile, worst.
#include <algorithm>
#include <vector>

#include <benchmark/benchmark.h>

namespace fidservo::bench {

/// The value that a share of all is not above.
inline double quantile(std::vector<double> values, double share) {
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Counters median_ms, p99_ms and worst_ms.
inline void report_times(benchmark::State& state, const std::vector<double>& times_ms) {
    state.counters["median_ms"] = quantile(times_ms, 0.5);
    state.counters["p99_ms"] = quantile(times_ms, 0.99);
    state.counters["worst_ms"] = quantile(times_ms, 1.0);
}

}  // namespace fidservo::bench
