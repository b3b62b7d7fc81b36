// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/predictive_density.h"

#include "gap/evidence/halves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fidservo::gap {
namespace {

constexpr double degrees_of_freedom = 4.0;

double log_density(double mean_square, double variance) {
    return -0.5 * std::log(variance) -
           0.5 * (degrees_of_freedom + 1.0) * std::log1p(mean_square / (degrees_of_freedom * variance));
}

/// Some windows of one signal.
struct SignalWindows {
    std::vector<double> mean_squares, expected;

    double log_density_under(double discrepancy) const {
        double sum = 0.0;
        for (std::size_t k = 0; k < mean_squares.size(); ++k)
            sum += log_density(mean_squares[k], expected[k] + discrepancy * discrepancy);
        return sum;
    }

    double likeliest_discrepancy() const {
        constexpr double least = 0.05, step = 1.05;
        if (mean_squares.empty()) return 0.0;
        const double most = std::sqrt(*std::ranges::max_element(mean_squares));
        std::pair best{log_density_under(0.0), 0.0};
        for (double level = least; level <= most; level *= step)
            best = std::max(best, std::pair{log_density_under(level), level});
        return best.second;
    }
};

Discrepancy likeliest(std::span<const Window> windows, std::span<const double> mean_squares,
                      const Wanted& counted) {
    std::array<SignalWindows, signal_count> of_signal;
    for (std::size_t w = 0; w < windows.size(); ++w) {
        if (counted[w] == 0 || std::isnan(mean_squares[w])) continue;
        SignalWindows& here = of_signal[index_of(windows[w].signal)];
        here.mean_squares.push_back(mean_squares[w]);
        here.expected.push_back(windows[w].expected_square);
    }
    Discrepancy levels{};
    for (std::size_t s = 0; s < signal_count; ++s) levels[s] = of_signal[s].likeliest_discrepancy();
    return levels;
}

}  // namespace

double independent_share(double windows, double expected_square, double discrepancy) {
    const double connected = discrepancy * discrepancy / (expected_square + discrepancy * discrepancy);
    return 1.0 / (1.0 + (windows - 1.0) * connected);
}

Discrepancy discrepancy_of(std::span<const Window> windows, std::span<const double> mean_squares) {
    return likeliest(windows, mean_squares, Wanted(windows.size(), 1));
}

std::vector<double> log_densities(const Evidence& evidence, std::span<const double> mean_squares,
                                  const Wanted& counted, const Discrepancy& shared) {
    const std::vector<Window>& windows = evidence.windows();
    const std::vector<std::uint8_t> half = halves(evidence);
    std::array<Discrepancy, 2> levels;
    for (std::size_t side = 0; side < 2; ++side) {
        Wanted others = counted;
        for (std::size_t w = 0; w < windows.size(); ++w)
            if (half[w] == side) others[w] = 0;
        levels[side] = likeliest(windows, mean_squares, others);
    }
    struct Sums {
        double log_density = 0.0, expected = 0.0, windows = 0.0;
    };
    std::vector<std::array<Sums, signal_count>> sums(evidence.recordings().size());
    for (std::size_t w = 0; w < windows.size(); ++w) {
        if (counted[w] == 0) continue;
        const std::size_t s = index_of(windows[w].signal);
        const double level = levels[half[w]][s], expected = windows[w].expected_square;
        Sums& here = sums[windows[w].run][s];
        here.log_density += log_density(mean_squares[w], expected + level * level);
        here.expected += expected;
        here.windows += 1.0;
    }
    std::vector<double> of_recording(sums.size(), 0.0);
    for (std::size_t run = 0; run < sums.size(); ++run)
        for (std::size_t s = 0; s < signal_count; ++s) {
            const Sums& here = sums[run][s];
            if (here.windows > 0.0)
                of_recording[run] += here.log_density *
                                     independent_share(here.windows, here.expected / here.windows, shared[s]);
        }
    return of_recording;
}

}  // namespace fidservo::gap
