// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/gap_size.h"

#include "core/random.h"
#include "gap/fit/score.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fidservo::gap {
namespace {

/// Means over signals of squared gaps, each of which counts as 1 (the floor) at least.
class MeanOverSignals {
  public:
    void add(double before_square, double after_square) {
        before_ += std::max(1.0, before_square);
        after_ += std::max(1.0, after_square);
        count_ += 1.0;
    }

    /// 1 (the floor) where no signal was added.
    TotalGap root() const {
        if (count_ == 0.0) return {1.0, 1.0};
        return {std::sqrt(before_ / count_), std::sqrt(after_ / count_)};
    }

  private:
    double before_ = 0.0, after_ = 0.0, count_ = 0.0;
};

/// For each signal, sums over windows of the squared errors in floors before and after, of the number of
/// values, and of the squares expected under the truth.
struct Sums {
    std::array<double, signal_count> before{}, after{}, values{}, expected{};

    void add(const Window& window, double before_square, double after_square) {
        if (std::isnan(before_square) || std::isnan(after_square)) return;
        const auto signal = index_of(window.signal);
        const auto count = static_cast<double>(window.end - window.begin);
        before[signal] += count * before_square;
        after[signal] += count * after_square;
        values[signal] += count;
        expected[signal] += count * window.expected_square;
    }

    TotalGap total() const {
        MeanOverSignals mean;
        for (std::size_t s = 0; s < signal_count; ++s)
            if (values[s] > 0.0) mean.add(before[s] / values[s], after[s] / values[s]);
        return mean.root();
    }
};

}  // namespace

std::vector<SignalGap> signal_gaps(const Evidence& evidence, std::span<const double> before,
                                   std::span<const double> after) {
    Sums sums;
    for (std::size_t w = 0; w < before.size(); ++w) sums.add(evidence.windows()[w], before[w], after[w]);
    std::vector<SignalGap> gaps;
    for (std::size_t s = 0; s < signal_count; ++s) {
        if (sums.values[s] == 0.0) continue;
        const auto signal = static_cast<Signal>(s);
        const double floor = evidence.floor(signal), square_left = sums.after[s] / sums.values[s];
        const double expected = sums.expected[s] / sums.values[s];
        const bool is_off = square_left > least_floors * least_floors * expected;
        gaps.push_back({.signal = signal,
                        .before = floor * std::sqrt(sums.before[s] / sums.values[s]),
                        .after = floor * std::sqrt(square_left),
                        .floor = floor,
                        .discrepancy = is_off ? floor * std::sqrt(square_left - expected) : 0.0});
    }
    return gaps;
}

bool is_left(const SignalGap& signal) {
    return signal.after > least_floors * signal.floor;
}

SignalFlags signals_left(std::span<const SignalGap> signals) {
    SignalFlags left{};
    for (const SignalGap& signal : signals) left[index_of(signal.signal)] = is_left(signal);
    return left;
}

TotalGap total_gap(std::span<const SignalGap> signals) {
    MeanOverSignals mean;
    for (const SignalGap& signal : signals)
        mean.add(std::pow(signal.before / signal.floor, 2), std::pow(signal.after / signal.floor, 2));
    return mean.root();
}

double TotalGap::removed() const {
    const double excess = before * before - 1.0;
    return excess > 0.0 ? std::clamp(1.0 - (after * after - 1.0) / excess, 0.0, 1.0) : 0.0;
}

std::pair<double, double> removed_interval(const Evidence& evidence, std::span<const double> before,
                                           std::span<const double> after) {
    constexpr double tail = 0.025;
    const std::size_t blocks = (before.size() + windows_in_correlation - 1) / windows_in_correlation;
    if (blocks == 0) return {0.0, 0.0};
    NoiseStream random(1, "bootstrap of the gap removed");
    std::vector<double> removed;
    for (int draw = 0; draw < bootstrap_draws; ++draw) {
        Sums sums;
        for (std::size_t k = 0; k < blocks; ++k) {
            const auto which = std::min(
                blocks - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(blocks)));
            for (std::size_t w = windows_in_correlation * which;
                 w < std::min(before.size(), windows_in_correlation * (which + 1)); ++w)
                sums.add(evidence.windows()[w], before[w], after[w]);
        }
        removed.push_back(sums.total().removed());
    }
    std::ranges::sort(removed);
    const auto at = [&](double share) {
        return removed[static_cast<std::size_t>(share * (bootstrap_draws - 1))];
    };
    return {at(tail), at(1.0 - tail)};
}

std::array<double, signal_count> typical_floors(std::span<const Window> windows,
                                                std::span<const double> mean_squares) {
    std::array<double, signal_count> logs{}, counts{}, floors{};
    for (std::size_t w = 0; w < windows.size(); ++w) {
        if (std::isnan(mean_squares[w])) continue;
        logs[index_of(windows[w].signal)] += std::log1p(mean_squares[w]);
        counts[index_of(windows[w].signal)] += 1.0;
    }
    for (std::size_t s = 0; s < signal_count; ++s)
        floors[s] = counts[s] > 0.0 ? std::max(1.0, std::sqrt(std::expm1(logs[s] / counts[s]))) : 1.0;
    return floors;
}

}  // namespace fidservo::gap
