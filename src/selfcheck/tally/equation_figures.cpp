// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/tally/equation_figures.h"

#include <functional>

namespace fidservo::selfcheck {
namespace {

using Condition = std::function<bool(const Outcome&)>;

bool is_asked_for(const Outcome& outcome) {
    return outcome.score.equation.has_value() && outcome.score.floors >= equation_floors;
}

bool is_proposed(const Outcome& outcome) {
    return !outcome.score.equation->formula.empty();
}

/// Beside names that explain what there is, an equation has nothing to say.
bool is_explained(const Outcome& outcome) {
    return outcome.score.all_right;
}

}  // namespace

std::vector<ShareFigure> equation_shares(std::span<const Outcome> outcomes) {
    std::vector<ShareFigure> shares;
    const auto add = [&](std::string name, std::string text, const Condition& counts, const Condition& hits,
                         std::optional<double> at_least) {
        Share share;
        for (const Outcome& outcome : outcomes)
            if (counts(outcome)) share.add(hits(outcome));
        shares.push_back({std::move(name), std::move(text), share, at_least});
    };
    const Condition proposes = [](const Outcome& outcome) { return outcome.score.proposes_equation; };
    const Condition proposes_none = [](const Outcome& outcome) { return !outcome.score.proposes_equation; };
    add("equation_proposed", "no right name, 10 floors or more: an equation is proposed", is_asked_for,
        is_proposed, 0.80);
    add(
        "equation_variables", "no right name: proposed with the right variables", is_asked_for,
        [](const Outcome& outcome) { return outcome.score.equation->right_variables; }, 0.70);
    add(
        "equation_form", "no right name: proposed, within 5 % of the true function over the data",
        is_asked_for, [](const Outcome& outcome) { return outcome.score.equation->apart < right_form; },
        0.50);
    add(
        "equation_none", "no effect: no equation is proposed",
        [](const Outcome& outcome) { return outcome.label.kind == CaseKind::none; }, proposes_none, 1.0);
    add("equation_beside", "explained by true names alone: an equation is proposed beside", is_explained,
        proposes, {});
    return shares;
}

std::vector<LimitFigure> equation_limits(std::span<const Outcome> outcomes) {
    std::vector<double> left, left_of_kinds;
    for (const Outcome& outcome : outcomes) {
        if (!is_asked_for(outcome) || !is_proposed(outcome)) continue;
        const EquationScore& equation = *outcome.score.equation;
        left.push_back(1.0 - equation.removed);
        if (equation.removed_of_kinds_left_out)
            left_of_kinds.push_back(1.0 - *equation.removed_of_kinds_left_out);
    }
    return {
        {"equation_not_removed", "what equations leave of the gap on held-out recordings, median",
         quantile(left, 0.5), 0.10},
        {"equation_not_removed_of_kinds",
         "what equations leave of the gap on kinds of experiment left out, median",
         quantile(left_of_kinds, 0.5), 0.30},
    };
}

}  // namespace fidservo::selfcheck
