#include "gap/equation/equation.h"

#include "core/rig.h"
#include "gap/balance/period_search.h"
#include "gap/equation/screening.h"
#include "gap/evidence/halves.h"
#include "gap/fit/gap_size.h"
#include "gap/fit/score.h"
#include "gap/residuals/accusation.h"
#include "gap/search/selection.h"
#include "plant/formulas/formula_effect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::gap {

namespace {

using plant::Port;

/// Ports of a block first, then the others of its stage.
std::vector<Port> ports_for(std::string_view block) {
    std::vector<Port> found;
    for (const bool of_block : {true, false})
        for (const plant::PortDescription& port : plant::ports()) {
            const bool allows = std::ranges::find(port.blocks, block) != port.blocks.end();
            if (allows != of_block || stage_of(port.blocks.front()) != stage_of(block)) continue;
            found.push_back(port.port);
        }
    return found;
}

std::string coefficient_unit(std::string_view of_port, const std::string& of_term) {
    const std::string unit = of_port.empty() ? "1" : std::string(of_port);
    if (of_term.empty()) return of_port.empty() ? "" : unit;
    return of_term.find_first_of(" /") == std::string::npos ? fmt::format("{}/{}", unit, of_term)
                                                            : fmt::format("{}/({})", unit, of_term);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

/// A sketch as a formula: coefficients a, b, c, d; shapes p, q.
FormulaEffect formula_of(const Sketch& sketch, std::string_view block, const std::string& name) {
    const plant::PortDescription& port = plant::describe(sketch.port);
    FormulaEffect effect;
    effect.name = name;
    effect.acts_on = port.name;
    const bool may_be = std::ranges::find(port.blocks, block) != port.blocks.end();
    effect.block = may_be ? std::string(block) : std::string(port.blocks.front());
    std::vector<std::string> words;
    char coefficient = 'a', shape = 'p';
    std::size_t at = 0;
    for (const Term& term : sketch.terms) {
        for (const std::string& text : term.texts) {
            constexpr double reach = 30.0;
            const std::string letter(1, coefficient++);
            const double value = sketch.coefficients[at++];
            const double most = reach * std::max(std::abs(value), 1e-12);
            effect.formula += fmt::format("{}{} * {}", effect.formula.empty() ? "" : " + ", letter,
                                          replaced(text, "shape", std::string(1, shape)));
            effect.parameters.push_back({.name = letter,
                                         .unit = coefficient_unit(port.unit, term.unit),
                                         .low = -most,
                                         .high = most,
                                         .typical = value != 0.0 ? value : 1e-12,
                                         .text = term.words});
        }
        if (term.shape)
            effect.parameters.push_back({.name = std::string(1, shape++),
                                         .unit = term.shape->unit,
                                         .low = term.shape->low,
                                         .high = term.shape->high,
                                         .vanishing = term.shape->value,
                                         .typical = term.shape->value,
                                         .role = "shape",
                                         .starts = {term.shape->value},
                                         .text = "of what is " + term.words});
        words.push_back(term.words);
    }
    effect.text = fmt::format(
        "Proposed by a diagnosis for what no listed effect explains, at {}: {}. Beyond what the recordings "
        "have covered, powers are continued by their end values.",
        port.name, fmt::join(words, "; and "));
    effect.source = "the recordings of this rig";
    return effect;
}

/// A sketch in the simulator.
struct FittedSketch {
    Sketch sketch;
    const plant::Effect* effect;
    CrossFit fitted;
};

class EquationSearch {
  public:
    EquationSearch(const Evidence& evidence, const CrossFit& base, std::string_view block, std::string name,
                   double tail)
        : evidence_(evidence),
          base_(base),
          block_(block),
          name_(std::move(name)),
          tail_(tail),
          fitter_(evidence, SearchOptions{}.windows, {}) {}

    std::optional<FittedSketch> best() {
        const Wanted all = everything(evidence_);
        Errors errors = evidence_.errors(base_.of_half[0], all);
        for (std::size_t w = 0; w < base_.mean_squares.size(); ++w)
            if (std::isnan(base_.mean_squares[w]))
                for (std::size_t k = evidence_.windows()[w].begin; k < evidence_.windows()[w].end; ++k)
                    errors[k] = std::numeric_limits<float>::quiet_NaN();
        const CoveredRanges ranges = covered_ranges(evidence_);
        std::vector<double> periods_mm;
        if (stage_of(block_) == Stage::macro)
            for (const PositionPeriod& period : strongest_periods(evidence_, errors))
                if (periods_mm.size() < most_periods) periods_mm.push_back(period.period_mm);
        std::optional<FittedSketch> best;
        for (const Port port : ports_for(block_)) {
            const std::vector<Term> terms = terms_of(port, ranges, periods_mm);
            terms_tried_ += static_cast<int>(terms.size());
            const auto sketch = sketch_of(evidence_, base_.of_half[0], errors, port, terms, tail_);
            if (!sketch) continue;
            std::optional<FittedSketch> trial = tried(*sketch);
            if (trial && (!best || trial->fitted.loss < best->fitted.loss)) best = std::move(trial);
        }
        if (!best) return {};
        shorten(*best);
        return is_no_chance(base_.mean_squares, best->fitted.mean_squares) ? best : std::nullopt;
    }

  private:
    static constexpr std::size_t most_periods = 3;

    std::optional<FittedSketch> tried(const Sketch& sketch) const {
        FittedSketch trial{sketch, &plant::effect_of(formula_of(sketch, block_, name_)), base_};
        for (Hypothesis& hypothesis : trial.fitted.of_half)
            hypothesis.push_back(plant::typical_setting(*trial.effect));
        const Places last{base_.of_half[0].size()};
        for (std::size_t side = 0; side < 2; ++side) {
            Fit fit = fitter_.fit_places(side, trial.fitted.of_half[side], last, base_.mean_squares);
            // Again, by the windows that say most once the first fit is known.
            Errors errors = evidence_.errors(fit.hypothesis, fitter_.half(side));
            if (errors.empty()) return {};
            trial.fitted.of_half[side] =
                fitter_.fit_places(side, fit.hypothesis, last, mean_squares(evidence_.windows(), errors))
                    .hypothesis;
        }
        fitter_.judge_beside(base_, {trial.fitted.of_half[0].back()}, trial.fitted);
        if (!std::isfinite(trial.fitted.loss)) return {};
        return trial;
    }

    bool is_no_chance(std::span<const double> without, std::span<const double> with) const {
        const Comparison comparison = compare(evidence_.windows(), without, with);
        return comparison.gain > least_gain &&
               comparison.significance >
                   significance_bound(comparison.blocks, std::max(1, terms_tried_), tail_);
    }

    /// Gives up terms without which it is as good, the one that is missed least first.
    void shorten(FittedSketch& trial) const {
        while (trial.sketch.terms.size() > 1) {
            std::optional<FittedSketch> shortest;
            for (std::size_t t = 0; t < trial.sketch.terms.size(); ++t) {
                std::optional<FittedSketch> shorter = tried(without(trial.sketch, t));
                if (shorter && (!shortest || shorter->fitted.loss < shortest->fitted.loss))
                    shortest = std::move(shorter);
            }
            if (!shortest || is_no_chance(shortest->fitted.mean_squares, trial.fitted.mean_squares)) return;
            trial = *std::move(shortest);
        }
    }

    static Sketch without(const Sketch& sketch, std::size_t term) {
        Sketch rest{sketch.port, {}, {}};
        std::size_t at = 0;
        for (std::size_t t = 0; t < sketch.terms.size(); ++t)
            for (std::size_t k = 0; k < sketch.terms[t].texts.size(); ++k, ++at) {
                if (t == term) continue;
                if (k == 0) rest.terms.push_back(sketch.terms[t]);
                rest.coefficients.push_back(sketch.coefficients[at]);
            }
        return rest;
    }

    const Evidence& evidence_;
    const CrossFit& base_;
    std::string_view block_;
    std::string name_;
    double tail_;
    CrossFitter fitter_;
    int terms_tried_ = 0;
};

std::vector<std::string> variables_in(const plant::FormulaCode& code) {
    std::vector<std::string> names;
    const auto known = plant::variables_of(code.port().site);
    for (std::size_t k = 0; k < known.size(); ++k)
        if (code.uses(k)) names.emplace_back(known[k].name);
    return names;
}

}  // namespace

std::optional<ProposedEquation> equation_of(const Evidence& evidence, const CrossFit& base,
                                            const Remainder& remainder, int number, double tail) {
    EquationSearch search(evidence, base, remainder.block, fmt::format("unnamed_{}", number), tail);
    std::optional<FittedSketch> trial = search.best();
    if (!trial) return {};
    const plant::FormulaCode& code = *trial->effect->formula;
    const Fit fitted = fit_to_all(evidence, trial->fitted);
    const plant::EffectSetting& setting = fitted.hypothesis.back();
    Equation equation{.acts_on = std::string(code.port().name),
                      .formula = code.effect().formula,
                      .variables = variables_in(code),
                      .parameters = {},
                      .gap_removed = 0.0,
                      .gap_removed_low = 0.0,
                      .gap_removed_high = 0.0,
                      .text = code.effect().text,
                      .setting = setting};
    const auto all = static_cast<Eigen::Index>(fitted.covariance.rows());
    const auto own = static_cast<Eigen::Index>(setting.values.size());
    for (std::size_t k = 0; k < setting.values.size(); ++k) {
        const plant::EffectParameter& parameter = setting.effect->parameters[k];
        const Eigen::Index at = all - own + static_cast<Eigen::Index>(k);
        const double apart =
            0.5 * (trial->fitted.of_half[0].back().values[k] - trial->fitted.of_half[1].back().values[k]);
        equation.parameters.push_back(
            {std::string(parameter.name), std::string(parameter.unit), setting.values[k],
             std::hypot(std::sqrt(std::max(0.0, fitted.covariance(at, at))), apart)});
    }
    const auto gaps = signal_gaps(evidence, base.mean_squares, trial->fitted.mean_squares);
    equation.gap_removed = total_gap(gaps).removed();
    std::tie(equation.gap_removed_low, equation.gap_removed_high) =
        removed_interval(evidence, base.mean_squares, trial->fitted.mean_squares);
    return ProposedEquation{std::move(equation), std::move(trial->fitted)};
}

}  // namespace fidservo::gap
