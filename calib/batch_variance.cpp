// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/batch_variance.h"

#include "calib/significance.h"

#include <algorithm>
#include <cmath>

namespace fidservo::calib {

namespace {

constexpr std::size_t least_batches = 8;
constexpr double tail_of_correlation = 0.2;

struct BatchSums {
    double squares = 0.0, fourths = 0.0, neighbours = 0.0;
    std::size_t count = 0;
};

/// The pieces of a recording that do not fill a batch join its last one.
BatchSums sums_over(std::span<const std::vector<double>> recordings, std::size_t pieces) {
    BatchSums sums;
    for (const std::vector<double>& series : recordings) {
        if (series.empty()) continue;
        const std::size_t batches = std::max<std::size_t>(1, series.size() / pieces);
        double before = 0.0;
        for (std::size_t i = 0; i < batches; ++i) {
            double sum = 0.0;
            const std::size_t end = i + 1 == batches ? series.size() : (i + 1) * pieces;
            for (std::size_t k = i * pieces; k < end; ++k) sum += series[k];
            sums.squares += sum * sum;
            sums.fourths += sum * sum * sum * sum;
            sums.neighbours += before * sum;
            before = sum;
        }
        sums.count += batches;
    }
    return sums;
}

}  // namespace

BatchVariance batch_variance(std::span<const std::vector<double>> recordings, std::size_t fitted) {
    const double bound = normal_bound(tail_of_correlation);
    std::size_t pieces = 1;
    BatchSums sums = sums_over(recordings, pieces);
    for (;;) {
        if (sums.neighbours <= bound * sums.squares / std::sqrt(static_cast<double>(sums.count))) break;
        const BatchSums longer = sums_over(recordings, 2 * pieces);
        if (longer.count < least_batches || longer.count == sums.count) break;
        sums = longer;
        pieces *= 2;
    }
    const auto count = static_cast<double>(sums.count), parameters = static_cast<double>(fitted);
    const double unbiased = count > parameters + 1.0 ? count / (count - parameters) : count;
    const double variance = unbiased * (sums.squares + 2.0 * std::max(0.0, sums.neighbours));
    constexpr double normal_kurtosis = 3.0;
    const double mattering =
        sums.fourths > 0.0 ? normal_kurtosis * sums.squares * sums.squares / sums.fourths : count;
    return {variance, std::max(1.0, std::min(mattering, count - 1.0)), pieces};
}

}  // namespace fidservo::calib
