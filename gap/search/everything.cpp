// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/everything.h"

#include "core/median.h"
#include "gap/balance/force_balance.h"
#include "gap/fit/fit.h"
#include "gap/fit/incremental_prediction.h"
#include "gap/fit/score.h"
#include "gap/search/shape_screening.h"
#include "gap/search/worth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>

namespace fidservo::gap {
namespace {

/// Prior standard deviation of sizes about zero effect, in typical sizes.
constexpr double expected_sizes = 3.0;

/// A fit is close to the optimum once half of the windows that were off at its start have a mean square below
/// this.
constexpr double near_square = 2.0;

double median_square(const std::vector<double>& all, const Wanted& leading) {
    std::vector<double> squares;
    for (std::size_t w = 0; w < all.size(); ++w)
        if (leading[w] != 0 && !std::isnan(all[w])) squares.push_back(all[w]);
    return squares.empty() ? 0.0 : median_of(std::move(squares));
}

double median_square(const Evidence& evidence, const Errors& errors, const Wanted& leading) {
    return median_square(mean_squares(evidence.windows(), errors), leading);
}

/// The windows that tell how far a fit is from the optimum: of the signal that is furthest off, those whose
/// predictions are off at the start. Windows in which nothing moves are predicted by any hypothesis.
Wanted windows_off(const Evidence& evidence, const Wanted& wanted, const Errors& errors) {
    const std::vector<Window>& windows = evidence.windows();
    const std::vector<double> squares = mean_squares(windows, errors);
    Wanted furthest(windows.size(), 0);
    double most = 0.0;
    for (const Signal signal : {Signal::encoder, Signal::hall, Signal::tag}) {
        Wanted leading = only_of(windows, wanted, only(signal));
        for (std::size_t w = 0; w < windows.size(); ++w)
            if (!(squares[w] > near_square)) leading[w] = 0;
        const double square = median_square(squares, leading);
        if (square <= most) continue;
        most = square;
        furthest = std::move(leading);
    }
    return furthest;
}

/// Fits from a distant start in several steps, until nothing improves. In each step errors up to the present
/// median count as noise.
/// @param options  of each step, but for its end and its noise
Hypothesis approached(const Evidence& evidence, const Predict& predict, const Wanted& wanted,
                      const Wanted& leading, Hypothesis start, FitOptions options) {
    constexpr int most_levels = 6, iterations_a_level = 8;
    constexpr double hardly_less = 0.5, tolerance = 0.02;
    options.most_iterations = iterations_a_level;
    options.tolerance = tolerance;
    double last = std::numeric_limits<double>::infinity();
    for (int level = 0; level < most_levels; ++level) {
        const double square = median_square(evidence, predict(start), leading);
        if (square < near_square || square > hardly_less * last) break;
        last = square;
        options.scale_floors = std::sqrt(1.0 + square);
        start = fit(predict, evidence.windows(), wanted, start, options).hypothesis;
    }
    return start;
}

Fit fitted_closely(const Evidence& evidence, const Predict& predict, const Wanted& wanted,
                   const Hypothesis& start, FitOptions options) {
    constexpr double tolerance = 1e-6, hardly_worth = 0.01 * least_worth;
    options.tolerance = tolerance;
    options.least_improvement = hardly_worth;
    options.with_covariance = true;
    return fit(predict, evidence.windows(), wanted, start, options);
}

/// Derivatives by small steps, unless the path of the carriage is predicted.
FitOptions smooth_where_it_can_be(const Evidence& evidence, const Wanted& wanted) {
    const Wanted of_encoder = only_of(evidence.windows(), wanted, only(Signal::encoder));
    const bool is_predicted = std::ranges::find(of_encoder, 1) != of_encoder.end();
    return {.keeps_slopes = true, .step_scales = is_predicted ? usual_step : smooth_step};
}

/// Some of the candidates, with their settings and what each is worth as far as is known.
struct Chosen {
    std::vector<const Candidate*> candidates;
    Hypothesis settings;
    std::vector<double> worth;

    void keep(const std::vector<std::size_t>& places) {
        Chosen rest;
        for (const std::size_t c : places) {
            rest.candidates.push_back(candidates[c]);
            rest.settings.push_back(settings[c]);
            rest.worth.push_back(worth[c]);
        }
        *this = std::move(rest);
    }
};

/// All candidates without a shape of their own, at size zero, and those in `begun` with their settings there.
Chosen begun_with(std::span<const Candidate* const> candidates, const Hypothesis& begun) {
    Chosen chosen;
    for (const Candidate* candidate : candidates) {
        const auto known = std::ranges::find(begun, candidate->effect, &plant::EffectSetting::effect);
        if (known == begun.end() && has_a_shape(*candidate)) continue;
        chosen.candidates.push_back(candidate);
        chosen.settings.push_back(known != begun.end() ? *known
                                                       : of_size(*candidate, candidate->shapes.front(), 0.0));
    }
    return chosen;
}

}  // namespace

bool is_smooth(const Candidate& candidate) {
    const SignalFlags teachers = teachers_of(*candidate.effect);
    const bool is_taught_smoothly = teachers[index_of(Signal::hall)] || teachers[index_of(Signal::tag)];
    return is_taught_smoothly && !candidate.is_limit;
}

bool is_smooth_of_carriage(const Candidate& candidate) {
    return shows_in_balance(*candidate.effect) && !candidate.wave && !candidate.patch &&
           !candidate.is_limit && candidate.step_within_counts == 0.0;
}

NeededCandidates needed_of_everything(const Evidence& evidence, std::span<const Candidate* const> candidates,
                                      const std::array<Hypothesis, 2>& beside, const Hypothesis& begun,
                                      const std::array<Wanted, 2>& wanted) {
    // Numbers of iterations: most candidates that are not needed show before the values are known precisely.
    constexpr int at_first = 4, then = 15, at_last = 4;
    std::array<IncrementalPrediction, 2> incremental{IncrementalPrediction(evidence, beside[0], wanted[0]),
                                                     IncrementalPrediction(evidence, beside[1], wanted[1])};
    const std::array<Predict, 2> predict{std::ref(incremental[0]), std::ref(incremental[1])};
    Chosen chosen = begun_with(candidates, begun);
    const Wanted leading = windows_off(evidence, wanted[0], predict[0](chosen.settings));
    FitOptions options = smooth_where_it_can_be(evidence, wanted[0]);
    options.expected_sizes = expected_sizes;
    chosen.settings =
        approached(evidence, predict[0], wanted[0], leading, std::move(chosen.settings), options);
    const double square = median_square(evidence, predict[0](chosen.settings), leading);
    const bool is_near = square < near_square;
    if (!is_near && begun.empty()) return {};
    options.scale_floors = is_near ? 1.0 : std::sqrt(1.0 + square);
    std::array<Fit, 2> fitted;
    const auto fit_half = [&](std::size_t side, double sizes, int most_iterations) {
        options.expected_sizes = sizes;
        options.most_iterations = most_iterations;
        fitted[side] = fitted_closely(evidence, predict[side], wanted[side], chosen.settings, options);
    };
    const auto fit_first = [&](double sizes, int most_iterations) {
        fit_half(0, sizes, most_iterations);
        chosen.settings = fitted[0].hypothesis;
    };
    Demand demand;
    /// Removes candidates that are not needed. Returns whether there were any.
    const auto prune = [&](bool spares_held = false) {
        const std::size_t count = chosen.candidates.size();
        chosen.worth = worth_of_each(chosen.candidates, fitted[0]);
        chosen.keep(kept(chosen.candidates, fitted[0], demand, spares_held));
        return chosen.candidates.size() < count;
    };
    const auto fit_and_prune = [&] {
        do {
            fit_first(0.0, then);
            demand = Demand(evidence, wanted[0], predict[0](chosen.settings));
        } while (prune() && !chosen.candidates.empty());
    };
    /// What a number of candidates costs: each has to save the least worth.
    const auto cost = [&] {
        return fitted[0].loss + least_worth * static_cast<double>(chosen.settings.size());
    };
    /// Tries the other alternative of a choice: with the wrong one a second candidate makes up for what the
    /// two differ by.
    const auto try_other_choice = [&](std::size_t c, std::size_t parameter) {
        const Chosen chosen_before = chosen;
        const Fit fitted_before = fitted[0];
        const Demand demand_before = demand;
        const double cost_before = cost();
        const auto go_back = [&] {
            chosen = chosen_before;
            fitted[0] = fitted_before;
            demand = demand_before;
        };
        const plant::EffectParameter& choice = chosen.settings[c].effect->parameters[parameter];
        double& value = chosen.settings[c].values[parameter];
        value = choice.is_high(value) ? choice.low : choice.high;
        try {
            fit_and_prune();
        } catch (...) {
            go_back();
            throw;
        }
        const bool is_better = !chosen.candidates.empty() && cost() < cost_before;
        if (!is_better) go_back();
        return is_better;
    };
    /// The first alternative that is better is kept.
    const auto try_other_choices = [&] {
        for (std::size_t c = 0; c < chosen.settings.size(); ++c) {
            const plant::Effect& effect = *chosen.settings[c].effect;
            for (std::size_t k = 0; k < effect.parameters.size(); ++k)
                if (effect.parameters[k].is_choice() && !moves_carriage(effect) && try_other_choice(c, k))
                    return;
        }
    };
    /// Fits the other half, too, and keeps what is worth it there and on the first half. Returns whether that
    /// is everything.
    const auto test_on_other_half = [&](int most_iterations) {
        fit_half(1, 0.0, most_iterations);
        // What the first half says was found when it was pruned.
        const std::vector<double> there = worth_of_each(chosen.candidates, fitted[1]);
        std::vector<std::size_t> rest;
        Hypothesis of_other;
        for (std::size_t c = 0; c < there.size(); ++c) {
            if (std::min(chosen.worth[c], there[c]) >= demand.worth_of(*chosen.candidates[c])) {
                rest.push_back(c);
                of_other.push_back(fitted[1].hypothesis[c]);
            }
            chosen.worth[c] += there[c];
        }
        const bool is_all = rest.size() == there.size();
        chosen.keep(rest);
        fitted[1].hypothesis = std::move(of_other);
        return is_all;
    };
    fit_first(expected_sizes, at_first);
    prune(true);
    if (chosen.candidates.empty()) return {};
    std::optional<Ended> ended;
    try {
        for (bool is_all = false; !is_all;) {
            fit_and_prune();
            if (chosen.candidates.empty()) return {};
            try_other_choices();
            is_all = test_on_other_half(then);
            if (chosen.candidates.empty()) return {};
        }
    } catch (const BudgetEnded& end) {
        ended = end.how();
        try {
            evidence.budget()->end_search();
            demand = Demand(evidence, wanted[0], predict[0](chosen.settings));
            test_on_other_half(at_last);
        } catch (const BudgetEnded&) {
            fitted[1].hypothesis = chosen.settings;
        }
    }
    return {chosen.candidates, {chosen.settings, fitted[1].hypothesis}, chosen.worth, ended};
}

Hypothesis promising_shapes(const Evidence& evidence, std::span<const Candidate* const> candidates,
                            std::span<const plant::EffectSetting> waves, const Hypothesis& beside,
                            const Hypothesis& begun, const Wanted& wanted) {
    // Share of the loss that a wave has to save, since errors show one of many periods by chance.
    constexpr double worth_a_fit = 0.2;
    IncrementalPrediction incremental(evidence, beside, wanted);
    const Predict predict = std::ref(incremental);
    const Chosen others = begun_with(candidates, begun);
    std::vector<const Candidate*> shaped;
    std::vector<GridPoint> grid;
    for (const Candidate* candidate : candidates) {
        if (std::ranges::find(others.candidates, candidate) != others.candidates.end()) continue;
        if (!candidate->wave) shaped.push_back(candidate);
        for (const plant::EffectSetting& wave : waves)
            if (wave.effect == candidate->effect) grid.push_back({candidate, wave.values});
    }
    std::ranges::move(grid_of(shaped), std::back_inserter(grid));
    const Errors errors = predict(others.settings);
    const double square = median_square(evidence, errors, windows_off(evidence, wanted, errors));
    const double enough_for_a_wave = worth_a_fit * total_loss(evidence.windows(), wanted, errors);
    Hypothesis best;
    for (const ScreenedShape& shape : screened_shapes(predict, evidence.windows(), wanted, others.settings,
                                                      grid, std::sqrt(1.0 + square), expected_sizes)) {
        if (!shape.candidate->wave || shape.gain >= enough_for_a_wave) best.push_back(shape.setting);
    }
    return best;
}

}  // namespace fidservo::gap
