// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/tally/score.h"

#include "gap/candidates/candidate.h"
#include "gap/verdict/standing.h"
#include "plant/effects/catalogue.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace fidservo::selfcheck {
namespace {

using Classes = std::set<std::string>;

/// What a right answer may name.
Classes nameable(const Label& label) {
    Classes classes;
    const bool lacks_it = label.kind == CaseKind::withheld || label.kind == CaseKind::unlisted ||
                          label.kind == CaseKind::frames_withheld;
    if (!lacks_it)
        for (const TrueEffect& effect : label.effects) classes.insert(effect.class_name);
    return classes;
}

std::set<std::string> blocks_of(const Label& label) {
    std::set<std::string> blocks;
    for (const TrueEffect& truth : label.effects) {
        blocks.insert(truth.block);
        for (const plant::Effect* effect : plant::effect_catalogue())
            if (gap::class_of(effect->name) == truth.class_name) blocks.emplace(effect->block);
    }
    return blocks;
}

bool meet(const Classes& a, const Classes& b) {
    return std::ranges::any_of(a, [&](const std::string& name) { return b.contains(name); });
}

/// How many truths can each have a set of its own that holds it: a largest matching, by augmenting paths.
class Pairing {
  public:
    Pairing(const Classes& truths, const std::vector<Classes>& sets)
        : truths_(truths.begin(), truths.end()), sets_(sets), truth_of_(sets.size()) {
        for (std::size_t truth = 0; truth < truths_.size(); ++truth) {
            std::vector<bool> seen(sets_.size(), false);
            pairs_ += takes_set(truth, seen) ? 1 : 0;
        }
    }

    std::size_t pairs() const { return pairs_; }

  private:
    bool takes_set(std::size_t truth, std::vector<bool>& seen) {
        for (std::size_t k = 0; k < sets_.size(); ++k) {
            if (seen[k] || !sets_[k].contains(truths_[truth])) continue;
            seen[k] = true;
            if (truth_of_[k] && !takes_set(*truth_of_[k], seen)) continue;
            truth_of_[k] = truth;
            return true;
        }
        return false;
    }

    std::vector<std::string> truths_;
    const std::vector<Classes>& sets_;
    std::vector<std::optional<std::size_t>> truth_of_;
    std::size_t pairs_ = 0;
};

bool has_dominant(CaseKind kind) {
    return kind == CaseKind::messy || kind == CaseKind::rough;
}

double confidence_limit(CaseKind kind) {
    const bool has_many = kind == CaseKind::three || kind == CaseKind::messy_none || has_dominant(kind);
    return has_many ? confident_of_crowded : confident;
}

/// What is left of a gap in squares, of which a share in excess of the floor is removed.
double gap_left(double before, double removed) {
    return std::sqrt(1.0 + (1.0 - removed) * std::max(0.0, before * before - 1.0));
}

std::optional<double> removed_of_true(const TrueDiscrepancy& left, const gap::TotalGap& gap) {
    const double removable = gap.before * gap.before - 1.0 - left.gap_floors * left.gap_floors;
    if (removable <= 0.0) return {};
    return std::clamp((gap.before * gap.before - gap.after * gap.after) / removable, 0.0, 1.0);
}

/// Held-out data decide between a name and an equation in its place, after the name's own probability.
bool is_replaced(const gap::FoundEffect& found) {
    constexpr double most = 0.5;
    return found.probability < most * gap::calibrated_probability(found.support);
}

}  // namespace

std::set<std::string> classes_named(const gap::FoundEffect& found) {
    Classes classes{std::string(gap::class_of(found.effect))};
    for (const std::string& other : found.indistinguishable_from) classes.emplace(gap::class_of(other));
    return classes;
}

Score score(const Label& label, const gap::Diagnosis& diagnosis, const gap::Evidence* evidence) {
    Score score;
    score.verdict = diagnosis.verdict;
    score.before = diagnosis.gap.before;
    score.after = diagnosis.gap.after;
    score.removed = diagnosis.gap.removed();
    for (const gap::SignalGap& signal : diagnosis.signals) {
        score.floors = std::max(score.floors, signal.before / signal.floor);
        score.floors_left = std::max(score.floors_left, signal.after / signal.floor);
    }
    const Classes truths = nameable(label);
    const double limit = confidence_limit(label.kind);
    std::vector<Classes> sets;
    double gap_before = score.before;
    for (const gap::FoundEffect& found : diagnosis.effects) {
        sets.push_back(classes_named(found));
        const bool is_right = meet(truths, sets.back());
        const double gap_after = gap_left(score.before, found.gap_removed);
        score.named.push_back({found.effect, std::string(gap::class_of(found.effect)), is_right,
                               found.probability, found.support, is_replaced(found), gap_before, gap_after});
        gap_before = gap_after;
        score.any_right = score.any_right || is_right;
        score.is_confident_wrong = score.is_confident_wrong || (!is_right && found.probability >= limit);
        if (has_dominant(label.kind) && !score.dominant_place &&
            sets.back().contains(label.effects.front().class_name))
            score.dominant_place = sets.size() - 1;
    }
    if (label.kind == CaseKind::messy && label.discrepancy)
        score.removed_of_true = removed_of_true(*label.discrepancy, diagnosis.gap);
    if (!diagnosis.where.empty()) score.first_block = diagnosis.where.front().block;
    if (!sets.empty()) {
        score.first_probability = diagnosis.effects.front().probability;
        score.set_size = sets.front().size();
        score.right_effect_first = meet(truths, sets.front());
    }
    score.right_block_first = blocks_of(label).contains(score.first_block);
    score.truths_named = Pairing(truths, sets).pairs();
    score.all_right = !truths.empty() && score.truths_named == truths.size() && sets.size() == truths.size();
    score.says_unexplained =
        diagnosis.verdict == gap::Verdict::unexplained || diagnosis.verdict == gap::Verdict::partly_explained;
    score.proposes_equation = gap::proposed_equation(diagnosis) != nullptr;
    if (evidence != nullptr && !label.effects.empty() && label.effects.front().as_formula)
        score.equation = score_equation(*label.effects.front().as_formula, diagnosis, *evidence);
    return score;
}

}  // namespace fidservo::selfcheck
