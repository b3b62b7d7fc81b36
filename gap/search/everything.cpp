// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/everything.h"

#include "gap/balance/force_balance.h"
#include "gap/fit/fit.h"
#include "gap/fit/incremental_prediction.h"
#include "gap/fit/score.h"
#include "gap/search/approach.h"
#include "gap/search/worth.h"
#include "gap/starts/shape_screening.h"
#include "gap/starts/wave_starts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

namespace fidservo::gap {
namespace {

/// Prior standard deviation of sizes about zero effect, in typical sizes.
constexpr double expected_sizes = 3.0;

Fit fitted_closely(const Evidence& evidence, const Predict& predict, const Wanted& wanted,
                   const Hypothesis& start, FitOptions options) {
    options.tolerance = close_tolerance;
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

/// The elimination of those candidates that the data do not need, on the first half and then on the other.
class Elimination {
  public:
    /// @param chosen   all candidates, with settings from which their fits start
    /// @param options  of all fits, but for their ends
    Elimination(const Evidence& evidence, const std::array<Hypothesis, 2>& beside,
                const std::array<Wanted, 2>& wanted, Chosen chosen, const FitOptions& options)
        : evidence_(evidence),
          wanted_(wanted),
          incremental_{IncrementalPrediction(evidence, beside[0], wanted[0]),
                       IncrementalPrediction(evidence, beside[1], wanted[1])},
          predict_{std::ref(incremental_[0]), std::ref(incremental_[1])},
          options_(options),
          now_{std::move(chosen), {}, {}} {}

    NeededCandidates needed(IfFar if_far, const Hypothesis& known) {
        // Most candidates that are not needed show before the values are known precisely.
        constexpr int at_first_or_last = 4;
        if (!comes_near() && if_far == IfFar::gives_up) return {};
        fit_first_half(expected_sizes, at_first_or_last);
        find_worth();
        now_.chosen.keep(kept(now_.chosen.candidates, now_.fitted, now_.demand, true));
        if (none_but(known)) return {};
        std::optional<Ended> ended;
        try {
            for (bool is_all = false; !is_all;) {
                fit_and_prune();
                if (none_but(known)) return {};
                try_changes();
                is_all = test_on_other_half(most_iterations);
                if (is_empty()) return {};
            }
        } catch (const BudgetEnded& end) {
            ended = end.how();
            try {
                evidence_.budget()->end_search();
                ask_of_each();
                test_on_other_half(at_first_or_last);
            } catch (const BudgetEnded&) {
                of_other_half_ = now_.chosen.settings;
            }
        }
        return {now_.chosen.candidates, {now_.chosen.settings, of_other_half_}, now_.chosen.worth, ended};
    }

  private:
    static constexpr int most_iterations = 15;

    /// What is chosen, as fitted to the first half, and what is demanded of it.
    struct State {
        Chosen chosen;
        Fit fitted;
        Demand demand;

        /// The loss where each candidate has to save the least worth.
        double cost() const {
            return fitted.loss + least_worth * static_cast<double>(chosen.settings.size());
        }
    };

    /// From the start to the neighbourhood of the optimum, if possible. Elsewhere, errors up to those that
    /// are left count as noise from then on.
    bool comes_near() {
        Chosen& chosen = now_.chosen;
        Approach near =
            approach(evidence_, chosen.candidates, predict_[0], wanted_[0], chosen.settings, options_);
        chosen.settings = std::move(near.settings);
        if (!near.is_near()) options_.scale_floors = std::sqrt(1.0 + near.median_square);
        return near.is_near();
    }

    bool is_empty() const { return now_.chosen.candidates.empty(); }

    bool none_but(const Hypothesis& known) const {
        return std::ranges::all_of(now_.chosen.settings, [&](const plant::EffectSetting& setting) {
            return has_effect(known, *setting.effect);
        });
    }

    Fit fitted_to(std::size_t side, double sizes, int iterations) const {
        FitOptions options = options_;
        options.expected_sizes = sizes;
        options.most_iterations = iterations;
        return fitted_closely(evidence_, predict_[side], wanted_[side], now_.chosen.settings, options);
    }

    void fit_first_half(double sizes, int iterations) {
        now_.fitted = fitted_to(0, sizes, iterations);
        now_.chosen.settings = now_.fitted.hypothesis;
    }

    /// Fits what is left, which may be nothing.
    void fit_rest() {
        if (is_empty())
            now_.fitted = {.hypothesis = {},
                           .loss = total_loss(evidence_.windows(), wanted_[0], predict_[0]({})),
                           .covariance = {}};
        else
            fit_first_half(0.0, most_iterations);
    }

    void find_worth() { now_.chosen.worth = worth_of_each(now_.chosen.candidates, now_.fitted); }

    void ask_of_each() { now_.demand = Demand(evidence_, wanted_[0], predict_[0](now_.chosen.settings)); }

    /// Keeps some of the candidates that were chosen before, whose worth is known, and fits them.
    /// @return whether the fit confirms that the others were not needed. Their worth follows from the loss to
    /// second order, which can be far from what a fit finds
    bool does_with(const State& before, const std::vector<std::size_t>& places) {
        now_ = before;
        now_.chosen.keep(places);
        double allowed = before.fitted.loss;
        for (const Candidate* candidate : before.chosen.candidates)
            if (std::ranges::find(now_.chosen.candidates, candidate) == now_.chosen.candidates.end())
                allowed += before.demand.worth_of(*candidate);
        fit_rest();
        return now_.fitted.loss < allowed;
    }

    /// Removes what is not needed and fits the rest, again and again. Where a fit contradicts, only the
    /// candidate that saves least is removed; where it still does, all are needed.
    void fit_and_prune() {
        fit_rest();
        while (!is_empty()) {
            ask_of_each();
            find_worth();
            const State before = now_;
            const std::vector<std::size_t> rest =
                kept(before.chosen.candidates, before.fitted, before.demand, false);
            const std::size_t removed = before.chosen.candidates.size() - rest.size();
            if (removed > 0 && does_with(before, rest)) continue;
            if (removed > 1 && does_with(before, all_but_least(before))) continue;
            now_ = before;
            return;
        }
    }

    /// Indices of all candidates but one.
    static std::vector<std::size_t> all_but(std::size_t left_out, const Chosen& chosen) {
        std::vector<std::size_t> rest(chosen.candidates.size());
        std::iota(rest.begin(), rest.end(), std::size_t{0});
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(left_out));
        return rest;
    }

    /// The one that saves least, relative to what is demanded of it, is left out.
    static std::vector<std::size_t> all_but_least(const State& state) {
        const Chosen& chosen = state.chosen;
        std::vector<double> shares;
        for (std::size_t c = 0; c < chosen.candidates.size(); ++c)
            shares.push_back(chosen.worth[c] / state.demand.worth_of(*chosen.candidates[c]));
        const auto least = std::ranges::min_element(shares) - shares.begin();
        return all_but(static_cast<std::size_t>(least), chosen);
    }

    /// Fits and prunes after a change of what is chosen, which is undone unless it turns out better.
    template <class Change>
    bool try_change(const Change& change) {
        const State before = now_;
        change(now_.chosen);
        try {
            fit_and_prune();
        } catch (...) {
            now_ = before;
            throw;
        }
        const bool is_better = !is_empty() && now_.cost() < before.cost();
        if (!is_better) now_ = before;
        return is_better;
    }

    /// Tries the other alternative of a choice: with the wrong one a second candidate makes up for what the
    /// two differ by.
    bool try_other_choice(std::size_t c, std::size_t parameter) {
        return try_change([&](Chosen& chosen) {
            const plant::EffectParameter& choice = chosen.settings[c].effect->parameters[parameter];
            double& value = chosen.settings[c].values[parameter];
            value = choice.is_high(value) ? choice.low : choice.high;
        });
    }

    bool try_without(std::size_t c) {
        return try_change([&](Chosen& chosen) { chosen.keep(all_but(c, chosen)); });
    }

    /// Tries the next values of each shape's grid on both sides, where what is left in the signals of the
    /// candidate is more than their noise: a fit ends on the way through a narrow valley of size and shape.
    bool try_other_shapes(std::size_t c) {
        const Candidate& candidate = *now_.chosen.candidates[c];
        if (now_.demand.worth_of(candidate) < 2.0 * least_worth) return false;
        const std::vector<double> values = now_.chosen.settings[c].values;  // changes replace those
        for (std::size_t k = 0; k < values.size(); ++k) {
            std::set<double> grid;
            for (const std::vector<double>& shape : candidate.shapes) grid.insert(shape[k]);
            if (grid.size() < 2) continue;
            const auto above = grid.upper_bound(values[k]), at_least = grid.lower_bound(values[k]);
            std::vector<double> next;
            if (above != grid.end()) next.push_back(*above);
            if (at_least != grid.begin()) next.push_back(*std::prev(at_least));
            for (const double value : next)
                if (try_change([&](Chosen& chosen) { chosen.settings[c].values[k] = value; })) return true;
        }
        return false;
    }

    /// Tries what the loss near the optimum cannot tell: the other alternatives of choices, other shapes, and
    /// to do without a scale error of the encoder, whose loss has a minimum at every count and keeps the
    /// values of other candidates beside it. The first change that is better is kept.
    void try_changes() {
        for (std::size_t c = 0; c < now_.chosen.settings.size(); ++c) {
            if (now_.chosen.candidates[c]->step_within_counts != 0.0 && try_without(c)) return;
            if (try_other_shapes(c)) return;
            const plant::Effect& effect = *now_.chosen.settings[c].effect;
            for (std::size_t k = 0; k < effect.parameters.size(); ++k)
                if (effect.parameters[k].is_choice() && !moves_carriage(effect) && try_other_choice(c, k))
                    return;
        }
    }

    /// Fits the other half, too, and keeps what is worth it there and on the first half.
    /// @return whether that is everything
    bool test_on_other_half(int iterations) {
        const Fit fitted = fitted_to(1, 0.0, iterations);
        Chosen& chosen = now_.chosen;
        // What the first half says was found when it was pruned.
        const std::vector<double> there = worth_of_each(chosen.candidates, fitted);
        std::vector<std::size_t> rest;
        of_other_half_.clear();
        for (std::size_t c = 0; c < there.size(); ++c) {
            if (std::min(chosen.worth[c], there[c]) >= now_.demand.worth_of(*chosen.candidates[c])) {
                rest.push_back(c);
                of_other_half_.push_back(fitted.hypothesis[c]);
            }
            chosen.worth[c] += there[c];
        }
        const bool is_all = rest.size() == there.size();
        chosen.keep(rest);
        return is_all;
    }

    const Evidence& evidence_;
    const std::array<Wanted, 2>& wanted_;
    std::array<IncrementalPrediction, 2> incremental_;
    std::array<Predict, 2> predict_;
    FitOptions options_;
    State now_;
    Hypothesis of_other_half_;
};

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
                                      const Hypothesis& known, const std::array<Wanted, 2>& wanted,
                                      IfFar if_far) {
    FitOptions options = smooth_where_it_can_be(evidence, wanted[0]);
    options.expected_sizes = expected_sizes;
    return Elimination(evidence, beside, wanted, begun_with(candidates, begun), options)
        .needed(if_far, known);
}

Hypothesis promising_shapes(const Evidence& evidence, std::span<const Candidate* const> candidates,
                            std::span<const plant::EffectSetting> waves, const Hypothesis& beside,
                            const Hypothesis& begun, const Wanted& wanted) {
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
    const double square = median_square_off(evidence, wanted, errors);
    const double enough_for_a_wave = worth_of_wave * total_loss(evidence.windows(), wanted, errors);
    Hypothesis best;
    for (const ScreenedShape& shape : screened_shapes(predict, evidence.windows(), wanted, others.settings,
                                                      grid, std::sqrt(1.0 + square), expected_sizes)) {
        if (!shape.candidate->wave || shape.gain >= enough_for_a_wave) best.push_back(shape.setting);
    }
    return best;
}

}  // namespace fidservo::gap
