// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/equation/equation_search.h"

#include "core/parallel.h"
#include "gap/balance/period_search.h"
#include "gap/balance/tag_period.h"
#include "gap/candidates/coupling.h"
#include "gap/equation/scan.h"
#include "gap/equation/screening.h"
#include "gap/evidence/halves.h"
#include "gap/fit/gap_size.h"
#include "gap/fit/score.h"
#include "gap/numbers.h"
#include "gap/residuals/accusation.h"
#include "gap/search/selection.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::gap {

namespace {

using plant::Port;

/// The ports of a block's stage in three groups: the block's own ones, those at which its effects may act,
/// too, and the others. None where no port belongs to the block. Where the tags say that the encoder is
/// wrong, the others are those that displace tags as it does; the encoder's own signal tells them from it.
std::array<std::vector<Port>, 3> ports_for(std::string_view block, std::optional<Signal> signal) {
    if (block == plant::describe(Port::encoder).blocks.front() && signal == Signal::tag)
        return {{{Port::encoder}, {}, {Port::camera_x, Port::tag_x}}};
    std::array<std::vector<Port>, 3> parts;
    for (const plant::PortDescription& port : plant::ports()) {
        if (stage_of(port.blocks.front()) != stage_of(block)) continue;
        const bool may_be = std::ranges::find(port.blocks, block) != port.blocks.end();
        parts.at(port.blocks.front() == block ? 0 : may_be ? 1 : 2).push_back(port.port);
    }
    if (parts[0].empty() && parts[1].empty()) return {};
    return parts;
}

class EquationSearch {
  public:
    EquationSearch(const Evidence& evidence, const CrossFit& base, std::string_view block,
                   std::optional<Signal> signal, std::string name, double tail,
                   const std::optional<Rival>& rival)
        : evidence_(evidence),
          base_(base),
          beside_(base),
          rival_(rival),
          block_(block),
          signal_(signal),
          name_(std::move(name)),
          tail_(tail),
          fitter_(evidence, SearchOptions{}.windows, {}) {}

    std::optional<FittedSketch> best() {
        ranges_ = covered_ranges(evidence_);
        const Errors errors = judged_errors(base_.of_half[0]);
        if (stage_of(block_) == Stage::macro)
            for (const PositionPeriod& period : strongest_periods(evidence_, errors))
                if (periods_mm_.size() < most_periods) periods_mm_.push_back(period.period_mm);
        if (signal_ == Signal::tag)
            if (const double period_mm = strongest_tag_period_mm(evidence_, errors, WaveOf::camera);
                period_mm > 0.0)
                periods_mm_.push_back(period_mm);
        std::optional<FittedSketch> best;
        try {
            const auto try_all = [&](const std::vector<Sketch>& sketches) {
                for (const Promise& promise : most_promising(sketches, base_)) {
                    if (rival_ && promise.gain <= gain_of_rival(promise.sketch)) continue;
                    std::optional<FittedSketch> trial = tried(promise.sketch);
                    if (!trial) continue;
                    fit_together(*trial);
                    if (!best || trial->fitted.loss < best->fitted.loss) best = trial;
                    fitted_.push_back(*std::move(trial));
                }
                return best && leaves_nothing(*best);
            };
            for (const std::vector<Port>& ports : ports_for(block_, signal_))
                if (try_all(screened_at(ports, errors)) || try_all(scanned_at(ports)) ||
                    (rival_ && rival_->is_credible && !ports.empty()))
                    break;
            if (!best || is_made_up_for_beside_rival(*best)) return {};
            go_on_beside(*best);
            grow(*best);
            shorten(*best);
            simplify(*best);
        } catch (const BudgetEnded& end) {
            if (!best || end.how() == Ended::interrupted) throw;
            evidence_.budget()->prolong(working_out_s);  // to complete what was found until then
        }
        const bool is_something =
            signs_agree(*best) && is_no_chance(base_.mean_squares, best->fitted.mean_squares);
        return is_something ? best : std::nullopt;
    }

  private:
    static constexpr std::size_t most_periods = 3, most_leading = 2, most_fitted = wide_beam,
                                 most_tried = narrow_beam;
    static constexpr double working_out_s = 2.0;

    std::vector<Term> terms(Port port) {
        std::vector<Term> found = terms_of(port, ranges_, periods_mm_);
        terms_tried_ += static_cast<int>(found.size());
        return found;
    }

    bool leaves_nothing(const FittedSketch& trial) const {
        return total_gap(signal_gaps(evidence_, base_.mean_squares, trial.fitted.mean_squares)).after <
               least_floors;
    }

    /// Sketches by sparse regression.
    /// @param errors  of the base
    std::vector<Sketch> screened_at(const std::vector<Port>& ports, const Errors& errors) {
        std::vector<Sketch> sketches;
        for (const Port port : ports) {
            const PortScreening screening(evidence_, base_.of_half[0], errors, port, terms(port));
            if (auto sketch = screening.sketch(tail_)) sketches.push_back(*std::move(sketch));
            std::ranges::move(screening.leading(most_leading), std::back_inserter(sketches));
        }
        drop_repeated(sketches);
        return sketches;
    }

    /// Sketches by trials of larger coefficients.
    std::vector<Sketch> scanned_at(const std::vector<Port>& ports) const {
        std::vector<Sketch> sketches;
        for (const Port port : ports)
            std::ranges::move(
                scanned(evidence_, base_, port, terms_of(port, ranges_, periods_mm_), most_leading),
                std::back_inserter(sketches));
        return sketches;
    }

    /// A sketch, and the loss that it saves on the second half, to which it was not fitted.
    struct Promise {
        double gain = 0.0;
        Sketch sketch;
    };

    /// Sketches fitted to the first half, those that save most on the second half first. If there are many,
    /// only those are fitted that save most as they are.
    std::vector<Promise> most_promising(const std::vector<Sketch>& sketches, const CrossFit& beside) const {
        constexpr double any = -std::numeric_limits<double>::infinity();
        std::vector<Sketch> fitted = sketches;
        if (sketches.size() > most_fitted) {
            fitted.clear();
            for (Promise& promise : best_of(sketches, most_fitted, any, [&](const Sketch& sketch) {
                     return saved(sketch, with(sketch), beside);
                 }))
                fitted.push_back(std::move(promise.sketch));
        }
        return best_of(fitted, most_tried, 0.0,
                       [&](const Sketch& sketch) { return promised(sketch, beside); });
    }

    /// Loss that the rival saves on the second half, in the windows in which a sketch is judged.
    double gain_of_rival(const Sketch& sketch) const {
        const Wanted others =
            only_of(evidence_.windows(), fitter_.half(1), reached_by({with(sketch).back()}));
        double gain = 0.0;
        for (std::size_t w = 0; w < others.size(); ++w)
            if (others[w] != 0 && !std::isnan(base_.mean_squares[w]) &&
                !std::isnan(rival_->explanation.mean_squares[w]))
                gain += window_loss(base_.mean_squares[w]) - window_loss(rival_->explanation.mean_squares[w]);
        return gain;
    }

    /// Judges sketches, and returns those that save more than `least`, best first.
    static std::vector<Promise> best_of(const std::vector<Sketch>& sketches, std::size_t count, double least,
                                        const std::function<Promise(const Sketch&)>& judge) {
        std::vector<Promise> promises(sketches.size());
        parallel_for(sketches.size(), [&](std::size_t k) { promises[k] = judge(sketches[k]); });
        std::ranges::stable_sort(promises, std::greater{}, &Promise::gain);
        const auto end =
            std::ranges::find_if(promises, [&](const Promise& promise) { return !(promise.gain > least); });
        promises.erase(end, promises.end());
        if (promises.size() > count) promises.resize(count);
        return promises;
    }

    /// Keeps only the first of those sketches that differ merely in the values of their coefficients.
    static void drop_repeated(std::vector<Sketch>& sketches) {
        std::set<std::string> seen;
        std::erase_if(sketches, [&](const Sketch& sketch) {
            std::string text;
            for (const Term& term : sketch.terms) {
                text += fmt::format("{} ", fmt::join(term.texts, " "));
                for (const TermShape& shape : term.shapes) text += fmt::format("{} ", shape.value);
            }
            return !seen.insert(fmt::format("{} {}", static_cast<int>(sketch.port), text)).second;
        });
    }

    /// The present base with a sketch as it is.
    Hypothesis with(const Sketch& sketch) const {
        Hypothesis whole = beside_.of_half[0];
        whole.push_back(plant::typical_setting(plant::effect_of(formula_of(sketch, block_, name_))));
        return whole;
    }

    Promise promised(const Sketch& sketch, const CrossFit& beside) const {
        const Hypothesis start = with(sketch);
        constexpr int trial_iterations = 5;
        const Fit fit = fitter_.fit_places(0, start, {start.size() - 1}, beside.mean_squares,
                                           {.most_iterations = trial_iterations});
        return saved(sketch, fit.hypothesis, beside);
    }

    /// The loss that is saved on the second half.
    Promise saved(const Sketch& sketch, const Hypothesis& hypothesis, const CrossFit& beside) const {
        const Wanted others = only_of(evidence_.windows(), fitter_.half(1), reached_by({hypothesis.back()}));
        return {
            gained(evidence_.windows(), others, beside.mean_squares, evidence_.errors(hypothesis, others)),
            with_values(sketch, hypothesis.back().values)};
    }

    /// Errors of a hypothesis, in the windows that are judged.
    Errors judged_errors(const Hypothesis& hypothesis) const {
        Errors errors = evidence_.errors(hypothesis, everything(evidence_));
        for (std::size_t w = 0; w < base_.mean_squares.size(); ++w)
            if (std::isnan(base_.mean_squares[w]))
                std::fill(errors.begin() + static_cast<std::ptrdiff_t>(evidence_.windows()[w].begin),
                          errors.begin() + static_cast<std::ptrdiff_t>(evidence_.windows()[w].end),
                          std::numeric_limits<float>::quiet_NaN());
        return errors;
    }

    /// Adds further terms of the same port, screened beside the present formula, as long as each is
    /// significant.
    void grow(FittedSketch& trial) {
        for (;;) {
            const Hypothesis& whole = trial.fitted.of_half[0];
            const PortScreening screening(evidence_, whole, judged_errors(whole), trial.sketch.port,
                                          terms(trial.sketch.port));
            std::vector<Sketch> further = screening.leading(most_leading);
            std::ranges::move(scanned(evidence_, trial.fitted, trial.sketch.port,
                                      terms_of(trial.sketch.port, ranges_, periods_mm_), most_leading),
                              std::back_inserter(further));
            if (auto sketch = screening.sketch(tail_)) further.insert(further.begin(), first_of(*sketch));
            const Sketch present = fitted_values(trial);
            std::vector<Sketch> longer;
            for (const Sketch& more : further)
                if (auto both = joined(present, more)) longer.push_back(*std::move(both));
            drop_repeated(longer);
            const std::vector<Promise> promising = most_promising(longer, trial.fitted);
            const std::optional<FittedSketch> best =
                promising.empty() ? std::nullopt : tried(promising.front().sketch);
            if (!best || !signs_agree(*best) ||
                !is_no_chance(trial.fitted.mean_squares, best->fitted.mean_squares))
                return;
            trial = *best;
        }
    }

    /// The sketch with the values that were fitted to the first half.
    static Sketch fitted_values(const FittedSketch& trial) {
        return with_values(trial.sketch, trial.fitted.of_half[0].back().values);
    }

    /// Whether the coefficient of each term has the same sign on both halves; waves, with two coefficients,
    /// are not tested.
    static bool signs_agree(const FittedSketch& trial) {
        std::size_t value = 0;
        for (const Term& term : trial.sketch.terms) {
            for (std::size_t k = 0; k < term.texts.size(); ++k, ++value)
                if (term.texts.size() == 1 && trial.fitted.of_half[0].back().values[value] *
                                                      trial.fitted.of_half[1].back().values[value] <=
                                                  0.0)
                    return false;
            value += term.shapes.size();
        }
        return true;
    }

    std::optional<FittedSketch> tried(const Sketch& sketch) const { return tried_beside(beside_, sketch); }

    std::optional<FittedSketch> tried_beside(const CrossFit& beside, const Sketch& sketch) const {
        FittedSketch trial{sketch, &plant::effect_of(formula_of(sketch, block_, name_)), beside};
        for (Hypothesis& hypothesis : trial.fitted.of_half)
            hypothesis.push_back(plant::typical_setting(*trial.effect));
        const Places last{beside.of_half[0].size()};
        std::array<bool, 2> can_be{};
        parallel_for(2, [&](std::size_t side) {
            Hypothesis& of_side = trial.fitted.of_half[side];
            const Errors errors = evidence_.errors(of_side, fitter_.half(side));
            can_be[side] = !errors.empty();
            if (can_be[side])
                of_side = fitter_.fit_places(side, of_side, last, mean_squares(evidence_.windows(), errors))
                              .hypothesis;
        });
        if (!can_be[0] || !can_be[1]) return {};
        fitter_.judge_beside(beside, {trial.fitted.of_half[0].back()}, trial.fitted);
        if (!std::isfinite(trial.fitted.loss)) return {};
        return trial;
    }

    /// Refits named effects together with the formula, for whose lack their values had to compensate before.
    void fit_together(FittedSketch& trial) const {
        if (base_.of_half[0].empty()) return;
        CrossFit together = trial.fitted;
        fitter_.fit_again(together, teachers_of(*trial.effect));
        if (together.loss < trial.fitted.loss) trial.fitted = std::move(together);
    }

    /// From now on formulas are tried beside the named effects as refitted with this formula.
    void go_on_beside(const FittedSketch& trial) {
        if (base_.of_half[0].empty()) return;
        beside_ = trial.fitted;
        for (Hypothesis& hypothesis : beside_.of_half) hypothesis.pop_back();
        fitter_.judge(beside_);
    }

    /// Whether a credible rival with the formula added to it predicts as well as the formula alone. The rival
    /// may then be right, and a formula has to be sought in addition to it.
    bool is_made_up_for_beside_rival(const FittedSketch& trial) const {
        if (!rival_ || !rival_->is_credible) return false;
        const std::optional<FittedSketch> beside = tried_beside(rival_->explanation, fitted_values(trial));
        return beside && !is_no_chance(beside->fitted.mean_squares, trial.fitted.mean_squares);
    }

    bool is_no_chance(std::span<const double> without, std::span<const double> with) const {
        const Comparison comparison = compare(evidence_.windows(), without, with);
        return comparison.gain > least_gain &&
               comparison.significance >
                   significance_bound(comparison.blocks, std::max(1, terms_tried_), tail_);
    }

    /// Removes terms as long as the formula remains as good, the least important ones first.
    void shorten(FittedSketch& trial) const {
        while (trial.sketch.terms.size() > 1) {
            std::optional<FittedSketch> shortest;
            for (std::size_t t = 0; t < trial.sketch.terms.size(); ++t) {
                std::optional<FittedSketch> shorter = tried(without(fitted_values(trial), t));
                if (shorter && (!shortest || shorter->fitted.loss < shortest->fitted.loss))
                    shortest = std::move(shorter);
            }
            if (!shortest || is_no_chance(shortest->fitted.mean_squares, trial.fitted.mean_squares)) return;
            trial = *std::move(shortest);
        }
    }

    static std::size_t complexity(const Sketch& sketch) {
        return sketch.coefficients.size() + sketch.shapes();
    }

    /// Replaces the formula by the one with the fewest parameters, of all that were fitted, that is as good.
    void simplify(FittedSketch& trial) const {
        const FittedSketch* simplest = &trial;
        for (const FittedSketch& other : fitted_) {
            const std::size_t own = complexity(other.sketch), least = complexity(simplest->sketch);
            const bool is_simpler =
                own < least ||
                (own == least && other.fitted.loss < simplest->fitted.loss && simplest != &trial);
            if (is_simpler && !is_no_chance(other.fitted.mean_squares, trial.fitted.mean_squares))
                simplest = &other;
        }
        if (simplest != &trial) trial = *simplest;
    }

    const Evidence& evidence_;
    const CrossFit& base_;
    CrossFit beside_;  ///< the base, refitted together with the best formula
    std::optional<Rival> rival_;
    std::string_view block_;
    std::optional<Signal> signal_;
    std::string name_;
    double tail_;
    CrossFitter fitter_;
    CoveredRanges ranges_{};
    std::vector<double> periods_mm_;
    std::vector<FittedSketch> fitted_;
    int terms_tried_ = 0;
};

}  // namespace

std::optional<FittedSketch> search_equation(const Evidence& evidence, const CrossFit& base,
                                            std::string_view block, std::optional<Signal> signal,
                                            const std::string& name, double tail,
                                            const std::optional<Rival>& rival) {
    return EquationSearch(evidence, base, block, signal, name, tail, rival).best();
}

}  // namespace fidservo::gap
