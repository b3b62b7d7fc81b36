// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/tally/outcome.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::selfcheck {
namespace {

std::string alone(double gap_floors) {
    return gap_floors > 0.0 ? fmt::format(" {:.3g} floors", gap_floors) : "";
}

std::string names_of(const Score& score) {
    std::vector<std::string> names;
    for (const NamedEffect& named : score.named) names.push_back(named.class_name);
    return fmt::format("{}", fmt::join(names, " + "));
}

std::string truth_of(const Label& label) {
    std::vector<std::string> texts;
    for (const TrueEffect& effect : label.effects)
        texts.push_back(fmt::format("{}{} {:.3g} ({})", effect.effect,
                                    effect.formula.empty() ? "" : "/" + effect.formula, effect.size,
                                    effect.block) +
                        alone(effect.gap_floors));
    if (label.discrepancy)
        texts.push_back(fmt::format("discrepancy by {} {:.3g} ({})", label.discrepancy->depends_on,
                                    label.discrepancy->size, label.discrepancy->block) +
                        alone(label.discrepancy->gap_floors));
    return texts.empty() ? "" : fmt::format(": {}", fmt::join(texts, " + "));
}

bool is_right(const Label& label, const Score& score) {
    switch (label.kind) {
        case CaseKind::none:
        case CaseKind::frames_none:
            return score.verdict == gap::Verdict::no_gap;
        case CaseKind::one:
        case CaseKind::frames:
            return score.right_effect_first && score.right_block_first;
        case CaseKind::two:
        case CaseKind::three:
            return score.all_right;
        case CaseKind::messy:
        case CaseKind::rough:
            return score.dominant_place == 0 && !score.is_confident_wrong;
        case CaseKind::messy_none:
            return !score.is_confident_wrong;
        case CaseKind::withheld:
        case CaseKind::frames_withheld:
        case CaseKind::unlisted:
            break;
    }
    return score.right_block_first && !score.is_confident_wrong;
}

/// What is proposed, beside what it should be.
std::string equation_of(const Outcome& outcome) {
    const std::optional<EquationScore>& equation = outcome.score.equation;
    if (!equation) return "";
    const FormulaEffect& truth = *outcome.label.effects.front().as_formula;
    if (equation->formula.empty())
        return fmt::format("; no equation for {}: {}", truth.acts_on, truth.formula);
    return fmt::format("; {}: {} for {}: {}, {:.2g} apart, {:.3g} removed", equation->acts_on,
                       equation->formula, truth.acts_on, truth.formula, equation->apart, equation->removed);
}

}  // namespace

std::string line_of(const Outcome& outcome) {
    const Score& score = outcome.score;
    return (outcome.tie ? words_of(*outcome.tie) : "") +
           fmt::format(
               "case {:>4} {}{}; {:.3g} floors -> {}{}{}; {}; {:.3g} floors left{}, {:.3g} s + {:.3g} s, {}",
               outcome.number, name_of(outcome.label.kind), truth_of(outcome.label), score.floors,
               gap::name_of(score.verdict), score.named.empty() ? "" : ": ", names_of(score),
               score.named.empty() ? score.first_block
                                   : fmt::format("{} {:.2f}", score.first_block, score.first_probability),
               score.after, equation_of(outcome), outcome.recording_s, outcome.diagnosis_s,
               is_right(outcome.label, score) ? "right" : "WRONG");
}

}  // namespace fidservo::selfcheck
