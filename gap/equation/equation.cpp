// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/equation/equation.h"

#include "gap/equation/kinds_left_out.h"
#include "gap/fit/gap_size.h"
#include "gap/parameters.h"
#include "gap/search/selection.h"
#include "plant/formulas/formula_code.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace fidservo::gap {

namespace {

/// The part of the gap that an equation removes from each kind of experiment when fitted to the other kinds;
/// empty where all recordings are of one kind, or the time has ended.
std::optional<double> removed_of_kinds_left_out(const Evidence& evidence, std::span<const double> before,
                                                const CrossFit& fitted) {
    try {
        const std::vector<double> left_out = predicted_from_other_kinds(evidence, fitted);
        if (!left_out.empty()) return total_gap(signal_gaps(evidence, before, left_out)).removed();
    } catch (const BudgetEnded& end) {
        if (end.how() == Ended::interrupted) throw;
    }
    return {};
}

}  // namespace

std::optional<ProposedEquation> equation_of(const Evidence& evidence, const CrossFit& base,
                                            const Remainder& remainder, int number, double tail,
                                            const std::optional<Rival>& rival) {
    std::optional<FittedSketch> trial = search_equation(evidence, base, remainder.block, remainder.signal,
                                                        fmt::format("unnamed_{}", number), tail, rival);
    if (!trial) return {};
    const plant::FormulaCode& code = *trial->effect->formula;
    const Fit fitted = fit_to_all(evidence, trial->fitted);
    const plant::EffectSetting& setting = fitted.hypothesis.back();
    const std::array<Hypothesis, 2>& halves = trial->fitted.of_half;
    const auto own = static_cast<Eigen::Index>(setting.values.size());
    Equation equation{.acts_on = std::string(code.port().name),
                      .formula = code.effect().formula,
                      .variables = code.variable_names(),
                      .parameters = parameters_of(setting, {halves[0].back(), halves[1].back()},
                                                  fitted.covariance, fitted.covariance.rows() - own),
                      .gap_removed = 0.0,
                      .gap_removed_low = 0.0,
                      .gap_removed_high = 0.0,
                      .text = code.effect().text,
                      .setting = setting};
    const auto gaps = signal_gaps(evidence, base.mean_squares, trial->fitted.mean_squares);
    equation.gap_removed = total_gap(gaps).removed();
    std::tie(equation.gap_removed_low, equation.gap_removed_high) =
        removed_interval(evidence, base.mean_squares, trial->fitted.mean_squares);
    if (equation.gap_removed_low <= 0.0) return {};
    equation.gap_removed_of_kinds_left_out =
        removed_of_kinds_left_out(evidence, base.mean_squares, trial->fitted);
    return ProposedEquation{std::move(equation), std::move(trial->fitted), fitted};
}

}  // namespace fidservo::gap
