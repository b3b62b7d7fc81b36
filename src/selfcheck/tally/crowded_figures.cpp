// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/tally/crowded_figures.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace fidservo::selfcheck {
namespace {

using Figure = std::function<bool(const Outcome&)>;

Figure is_of(CaseKind kind) {
    return [kind](const Outcome& outcome) { return outcome.label.kind == kind; };
}

bool is_three_judged(const Outcome& outcome) {
    return outcome.label.kind == CaseKind::three &&
           std::ranges::all_of(outcome.label.effects, [](const TrueEffect& effect) {
               return effect.expected_floors >= judged_floors;
           });
}

bool is_not_confident_wrong(const Outcome& outcome) {
    return !outcome.score.is_confident_wrong;
}

/// 0 where it is not named.
double dominant_probability(const Score& score) {
    return score.dominant_place ? score.named[*score.dominant_place].probability : 0.0;
}

/// Of every name of one kind of case.
double calibration_error_of(CaseKind kind, std::span<const Outcome> outcomes) {
    std::vector<Claim> claims;
    for (const Outcome& outcome : outcomes)
        if (outcome.label.kind == kind)
            for (const NamedEffect& named : outcome.score.named)
                claims.push_back({named.probability, named.is_true});
    return reliability_of(std::move(claims)).expected_error;
}

}  // namespace

std::vector<ShareFigure> crowded_shares(std::span<const Outcome> outcomes) {
    std::vector<ShareFigure> shares;
    const auto add = [&](std::string name, std::string text, const Figure& counts, const Figure& hits,
                         std::optional<double> at_least) {
        Share share;
        for (const Outcome& outcome : outcomes)
            if (counts(outcome)) share.add(hits(outcome));
        shares.push_back({std::move(name), std::move(text), share, at_least});
    };
    const Figure three = is_of(CaseKind::three), messy = is_of(CaseKind::messy),
                 messy_none = is_of(CaseKind::messy_none), rough = is_of(CaseKind::rough);
    const Figure all_named = [](const Outcome& outcome) { return outcome.score.truths_named == 3; };
    const Figure all_right = [](const Outcome& outcome) { return outcome.score.all_right; };
    add("three_all", "three effects: all named", is_three_judged, all_named, 0.80);
    add(
        "three_two", "three effects: two named at least", is_three_judged,
        [](const Outcome& outcome) { return outcome.score.truths_named >= 2; }, 0.97);
    add("three_alone", "three effects: all named and no fourth", is_three_judged, all_right, {});
    add("three_not_confident", "three effects: no confident wrong name", is_three_judged,
        is_not_confident_wrong, 0.97);
    add("three_all_any_size", "three effects of any size: all named", three, all_named, {});
    add(
        "messy_dominant", "messy: dominant effect among the named", messy,
        [](const Outcome& outcome) { return outcome.score.dominant_place.has_value(); }, 0.95);
    add(
        "messy_dominant_first", "messy: dominant effect named first", messy,
        [](const Outcome& outcome) { return outcome.score.dominant_place == 0; }, 0.85);
    add("messy_dominant_likely", "messy: dominant effect named with a probability of 0.5 or more", messy,
        [](const Outcome& outcome) { return dominant_probability(outcome.score) >= 0.5; }, {});
    add("messy_not_confident", "messy: no confident wrong name", messy, is_not_confident_wrong, 0.97);
    add("messy_none_not_confident", "messy without a dominant effect: no confident wrong name", messy_none,
        is_not_confident_wrong, 0.97);
    add("messy_none_names_true", "messy without a dominant effect: every name is true", messy_none,
        [](const Outcome& outcome) {
            return std::ranges::all_of(outcome.score.named, &NamedEffect::is_true);
        },
        {});
    add("rough_dominant_first", "rough: larger effect named first", rough,
        [](const Outcome& outcome) { return outcome.score.dominant_place == 0; }, {});
    add("rough_all", "rough: both effects named", rough,
        [](const Outcome& outcome) { return outcome.score.truths_named == 2; }, {});
    add("rough_not_confident", "rough: no confident wrong name", rough, is_not_confident_wrong, 0.97);
    return shares;
}

std::vector<LimitFigure> crowded_limits(std::span<const Outcome> outcomes) {
    std::vector<double> probabilities, not_removed;
    for (const Outcome& outcome : outcomes) {
        if (outcome.label.kind != CaseKind::messy) continue;
        const Score& score = outcome.score;
        probabilities.push_back(dominant_probability(score));
        if (score.removed_of_true) not_removed.push_back(1.0 - *score.removed_of_true);
    }
    const double mean_not_removed = std::accumulate(not_removed.begin(), not_removed.end(), 0.0) /
                                    static_cast<double>(not_removed.size());
    return {
        {"messy_dominant_probability",
         "messy: probability of the dominant effect, median (0: not named)",
         quantile(probabilities, 0.5),
         {}},
        {"messy_not_removed", "messy: of what the true effects would remove, what the named leave, mean",
         mean_not_removed, 0.15},
        {"messy_calibration_error", "messy: expected calibration error of every name's probability",
         calibration_error_of(CaseKind::messy, outcomes), 0.05},
        {"rough_calibration_error",
         "rough: expected calibration error of every name's probability",
         calibration_error_of(CaseKind::rough, outcomes),
         {}},
    };
}

}  // namespace fidservo::selfcheck
