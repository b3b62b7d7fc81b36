#include "src/selfcheck/score.h"

#include "gap/candidate.h"
#include "plant/effects/catalogue.h"

#include <algorithm>
#include <set>

namespace fidservo::selfcheck {
namespace {

using Classes = std::set<std::string>;

Classes set_of(const gap::FoundEffect& found) {
    Classes classes{std::string(gap::class_of(found.effect))};
    for (const std::string& other : found.indistinguishable_from) classes.emplace(gap::class_of(other));
    return classes;
}

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

/// Whether truths and sets can be paired one to one. There are two of them at most.
bool pair_up(const Classes& truths, const std::vector<Classes>& sets) {
    if (truths.size() != sets.size() || truths.empty()) return false;
    std::vector<std::string> order(truths.begin(), truths.end());
    do {
        bool fits = true;
        for (std::size_t k = 0; k < order.size(); ++k) fits = fits && sets[k].contains(order[k]);
        if (fits) return true;
    } while (std::ranges::next_permutation(order).found);
    return false;
}

}  // namespace

Score score(const Label& label, const gap::Diagnosis& diagnosis) {
    Score score;
    score.verdict = diagnosis.verdict;
    score.before = diagnosis.gap.before;
    score.after = diagnosis.gap.after;
    score.removed = diagnosis.gap.removed();
    for (const gap::SignalGap& signal : diagnosis.signals)
        score.floors = std::max(score.floors, signal.before / signal.floor);
    const Classes truths = nameable(label);
    std::vector<Classes> sets;
    for (const gap::FoundEffect& found : diagnosis.effects) {
        score.named.emplace_back(gap::class_of(found.effect));
        sets.push_back(set_of(found));
        const bool is_right = meet(truths, sets.back());
        score.any_right = score.any_right || is_right;
        score.is_confident_wrong = score.is_confident_wrong || (!is_right && found.probability >= confident);
    }
    if (!diagnosis.where.empty()) score.first_block = diagnosis.where.front().block;
    if (!sets.empty()) {
        score.first_probability = diagnosis.effects.front().probability;
        score.set_size = sets.front().size();
        score.right_effect_first = meet(truths, sets.front());
    }
    score.right_block_first = blocks_of(label).contains(score.first_block);
    score.all_right = pair_up(truths, sets);
    score.says_unexplained =
        diagnosis.verdict == gap::Verdict::unexplained || diagnosis.verdict == gap::Verdict::partly_explained;
    return score;
}

}  // namespace fidservo::selfcheck
