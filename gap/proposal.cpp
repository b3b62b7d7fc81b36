// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/proposal.h"

#include "core/rig.h"
#include "gap/accused.h"
#include "gap/equation/equation.h"
#include "gap/fit/gap_size.h"
#include "gap/numbers.h"
#include "gap/parameters.h"
#include "gap/residuals/remainder.h"
#include "gap/verdict/model_weights.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

namespace fidservo::gap {
namespace {

/// An explanation, and what it leaves.
struct Base {
    const CrossFit& explained;
    std::optional<Remainder> left;
};

class Proposals {
  public:
    Proposals(const Evidence& evidence, const Selection& selection, const DiagnosisOptions& options,
              bool are_names_credible)
        : evidence_(evidence),
          options_(options),
          are_names_credible_(are_names_credible),
          named_{selection.steps.back(), remainder(selection.steps.back())},
          nothing_{selection.steps.front(), selection.choices.empty() ? named_.left : std::nullopt} {}

    /// Looks for what is left where nothing is named; to be called before an equation may replace names.
    void look_without_names() { nothing_.left = remainder(nothing_.explained); }

    const std::optional<Remainder>& left_by_nothing() const { return nothing_.left; }
    const std::optional<Remainder>& left_by_names() const { return named_.left; }

    std::optional<ProposedEquation> beside_names() const { return of(named_, {}); }

    double weight_of_names_against(const ProposedEquation& whole) const {
        return weight_of_first(evidence_, named_.explained.mean_squares, whole.fitted.mean_squares);
    }

    /// What is missing beside the names, or an equation in their place: the likelier of the two. Names that
    /// are credible are first asked what is missing beside them, others what could take their place; the
    /// second question is asked where the first answer leaves something. In doubt, or where the time for
    /// it ends, the first answer holds.
    std::optional<ProposedEquation> beside_or_in_place_of_names() const {
        const auto ask = [&](bool beside) { return beside ? beside_names() : in_place_of_names(); };
        std::optional<ProposedEquation> first = ask(are_names_credible_), second;
        if (first && leaves_nothing(*first)) return first;
        try {
            second = ask(!are_names_credible_);
        } catch (const BudgetEnded& end) {
            if (!first || end.how() == Ended::interrupted) throw;
        }
        if (!first || !second) return first ? std::move(first) : std::move(second);
        const double weight =
            weight_of_first(evidence_, first->fitted.mean_squares, second->fitted.mean_squares);
        return weight >= 0.5 ? std::move(first) : std::move(second);
    }

  private:
    /// For the whole gap, likelier than the names.
    std::optional<ProposedEquation> in_place_of_names() const {
        auto proposed = of(nothing_, Rival{named_.explained, are_names_credible_});
        if (!proposed || weight_of_names_against(*proposed) >= 0.5) return {};
        proposed->equation.in_place_of_names = true;
        return proposed;
    }

    bool leaves_nothing(const ProposedEquation& proposed) const {
        const auto gaps =
            signal_gaps(evidence_, nothing_.explained.mean_squares, proposed.fitted.mean_squares);
        return total_gap(gaps).after < least_floors;
    }

    std::optional<Remainder> remainder(const CrossFit& explained) const {
        return remainder_of(evidence_, explained, options_.selection.search.tail, options_.matters);
    }

    std::optional<ProposedEquation> of(const Base& base, const std::optional<Rival>& rival) const {
        if (!base.left) return {};
        const auto is_unnamed = [](const StatedEffect& effect) {
            return effect.name.starts_with("unnamed_");
        };
        const auto unnamed = std::ranges::count_if(evidence_.rig().effects, is_unnamed);
        return equation_of(evidence_, base.explained, *base.left, 1 + static_cast<int>(unnamed),
                           options_.selection.search.tail, rival);
    }

    const Evidence& evidence_;
    const DiagnosisOptions& options_;
    bool are_names_credible_;
    Base named_, nothing_;  ///< the same where nothing is named
};

/// The names are as likely as an equation in their place leaves them.
void stand_in_for_names(double weight_of_names, const std::string& block, Diagnosis& diagnosis) {
    for (FoundEffect& effect : diagnosis.effects) effect.probability *= weight_of_names;
    for (BlockProbability& accused : diagnosis.where) accused.probability *= weight_of_names;
    accuse(diagnosis.where, block, 1.0 - weight_of_names);
}

/// What the names are worth beside an equation that is no longer made up for by them.
void take_values(const ProposedEquation& beside, Diagnosis& diagnosis) {
    const Hypothesis& together = beside.of_all.hypothesis;
    const std::array<Hypothesis, 2>& halves = beside.fitted.of_half;
    Eigen::Index first = 0;
    for (std::size_t k = 0; k < diagnosis.effects.size(); ++k) {
        diagnosis.effects[k].parameters =
            parameters_of(together[k], {halves[0][k], halves[1][k]}, beside.of_all.covariance, first);
        first += static_cast<Eigen::Index>(together[k].values.size());
    }
    diagnosis.hypothesis.assign(together.begin(), std::prev(together.end()));
}

/// An equation that removes nearly all of what is left says best where that arises, and on what it depends.
void believe_equation(Diagnosis& diagnosis) {
    Remainder& left = *diagnosis.unexplained;
    const Equation& equation = *left.equation;
    if (equation.gap_removed < nearly_all) return;
    if (left.depends_on.empty()) left.depends_on = equation.variables;
    const std::string block(equation.setting.effect->block);
    if (left.block == block) return;
    const bool is_of_names =
        std::ranges::find(diagnosis.effects, left.block, &FoundEffect::block) != diagnosis.effects.end();
    const auto accused = std::ranges::find(diagnosis.where, left.block, &BlockProbability::block);
    if (accused != diagnosis.where.end()) {
        const double probability = accused->probability;
        if (!is_of_names) diagnosis.where.erase(accused);
        accuse(diagnosis.where, block, probability);
    }
    left.block = block;
}

/// @param diagnosis  also says what is left, if it did not yet
std::optional<ProposedEquation> equation_for(Proposals& proposals, Diagnosis& diagnosis) {
    std::optional<Remainder>& left = diagnosis.unexplained;
    if (!left) left = proposals.left_by_names();
    if (diagnosis.effects.empty()) return proposals.beside_names();
    proposals.look_without_names();
    if (!left) left = proposals.left_by_nothing();
    std::optional<ProposedEquation> likelier = proposals.beside_or_in_place_of_names();
    if (!likelier) return {};
    if (likelier->equation.in_place_of_names) {
        left = proposals.left_by_nothing();
        stand_in_for_names(proposals.weight_of_names_against(*likelier), left->block, diagnosis);
    } else {
        take_values(*likelier, diagnosis);
    }
    return likelier;
}

}  // namespace

Ended propose_equation(const Evidence& evidence, const Selection& selection, const DiagnosisOptions& options,
                       Diagnosis& diagnosis) {
    if (options.equation_s <= 0.0 || !is_gap_left(diagnosis.verdict)) return Ended::finished;
    evidence.budget()->prolong(options.equation_s);
    if (options.selection.search.tell) options.selection.search.tell("equation for what is left");
    try {
        Proposals proposals(evidence, selection, options, are_credible(diagnosis.effects));
        if (auto proposed = equation_for(proposals, diagnosis)) {
            diagnosis.unexplained->equation = std::move(proposed->equation);
            believe_equation(diagnosis);
        }
    } catch (const BudgetEnded& end) {
        if (end.how() == Ended::interrupted) return end.how();
        diagnosis.notes.emplace_back("no equation was found for what is left in the time for it");
    }
    return Ended::finished;
}

}  // namespace fidservo::gap
