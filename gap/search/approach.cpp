// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/approach.h"

#include "core/median.h"
#include "gap/candidates/coupling.h"
#include "gap/fit/score.h"
#include "gap/numbers.h"
#include "plant/effects/catalogue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace fidservo::gap {
namespace {

/// The median of the signal that is furthest off.
double median_square(const Evidence& evidence, const Errors& errors, const Wanted& leading) {
    const std::vector<Window>& windows = evidence.windows();
    const std::vector<double> all = mean_squares(windows, errors);
    std::array<std::vector<double>, signal_count> squares;
    for (std::size_t w = 0; w < all.size(); ++w)
        if (leading[w] != 0 && !std::isnan(all[w])) squares[index_of(windows[w].signal)].push_back(all[w]);
    double most = 0.0;
    for (std::vector<double>& of_signal : squares)
        if (!of_signal.empty()) most = std::max(most, median_of(std::move(of_signal)));
    return most;
}

/// Windows in which nothing moves are predicted by any hypothesis.
Wanted windows_off(const Evidence& evidence, const Wanted& wanted, const Errors& errors) {
    const std::vector<double> squares = mean_squares(evidence.windows(), errors);
    Wanted are_off = wanted;
    for (std::size_t w = 0; w < squares.size(); ++w)
        if (!(squares[w] > Approach::near_square)) are_off[w] = 0;
    return are_off;
}

Hypothesis best_within_counts(const Evidence& evidence, std::span<const Candidate* const> candidates,
                              const Predict& predict, const Wanted& wanted, Hypothesis best) {
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        if (candidates[c]->step_within_counts == 0.0) continue;
        double least = total_loss(evidence.windows(), wanted, predict(best));
        for (plant::EffectSetting& setting : settings_within_counts(*candidates[c])) {
            Hypothesis other = best;
            other[c] = std::move(setting);
            const double loss = total_loss(evidence.windows(), wanted, predict(other));
            if (loss >= least) continue;
            least = loss;
            best = std::move(other);
        }
    }
    return best;
}

Hypothesis without_effect(const Hypothesis& settings) {
    Hypothesis none;
    for (const plant::EffectSetting& setting : settings)
        none.push_back(plant::vanishing_setting(*setting.effect));
    return none;
}

}  // namespace

Approach approach(const Evidence& evidence, std::span<const Candidate* const> candidates,
                  const Predict& predict, const Wanted& wanted, Hypothesis start, FitOptions options) {
    constexpr int most_levels = 6, iterations_a_level = 8;
    constexpr double hardly_less = larger_part, tolerance = 0.02;
    const Wanted leading = windows_off(evidence, wanted, predict(without_effect(start)));
    options.most_iterations = iterations_a_level;
    options.tolerance = tolerance;
    const auto square_of = [&] { return median_square(evidence, predict(start), leading); };
    double last = std::numeric_limits<double>::infinity();
    for (int level = 0; level < most_levels; ++level) {
        start = best_within_counts(evidence, candidates, predict, wanted, std::move(start));
        const double square = square_of();
        if (square < Approach::near_square || square > hardly_less * last) return {std::move(start), square};
        last = square;
        options.scale_floors = std::sqrt(1.0 + square);
        start = fit(predict, evidence.windows(), wanted, start, options).hypothesis;
    }
    const double square = square_of();
    return {std::move(start), square};
}

double median_square_off(const Evidence& evidence, const Wanted& wanted, const Errors& errors) {
    return median_square(evidence, errors, windows_off(evidence, wanted, errors));
}

}  // namespace fidservo::gap
