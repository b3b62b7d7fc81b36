// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/tally/tally.h"

#include "src/selfcheck/tally/crowded_figures.h"
#include "src/selfcheck/tally/equation_figures.h"
#include "src/selfcheck/tally/tie_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

namespace fidservo::selfcheck {
namespace {

using enum CaseKind;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double removed_enough = 0.95, floors_after = 1.1;

bool is_judged(const Outcome& outcome) {
    return outcome.score.floors >= judged_floors;
}

/// Of two effects the smaller one counts.
bool both_are_judged(const Outcome& outcome) {
    return std::ranges::all_of(outcome.label.effects, [](const TrueEffect& effect) {
        return effect.expected_floors >= judged_floors;
    });
}

using Test = std::function<bool(const Outcome&)>;

Share share_of(std::span<const Outcome> outcomes, const Test& counts, const Test& hits) {
    Share share;
    for (const Outcome& outcome : outcomes)
        if (counts(outcome)) share.add(hits(outcome));
    return share;
}

Test judged(CaseKind kind) {
    return [kind](const Outcome& outcome) { return outcome.label.kind == kind && is_judged(outcome); };
}

bool has_one(const Outcome& outcome) {
    return outcome.label.kind == one || outcome.label.kind == frames;
}

bool is_explainable(const Outcome& outcome) {
    return is_judged(outcome) && (has_one(outcome) || outcome.label.kind == two);
}

std::vector<ShareFigure> shares_of(std::span<const Outcome> outcomes) {
    std::vector<ShareFigure> shares;
    const auto add = [&](std::string name, std::string text, const Test& counts, const Test& hits,
                         std::optional<double> at_least) {
        shares.push_back({std::move(name), std::move(text), share_of(outcomes, counts, hits), at_least});
    };
    const Test right_block = [](const Outcome& outcome) { return outcome.score.right_block_first; };
    const Test right_effect = [](const Outcome& outcome) { return outcome.score.right_effect_first; };
    const Test all_right = [](const Outcome& outcome) { return outcome.score.all_right; };
    const Test any_right = [](const Outcome& outcome) { return outcome.score.any_right; };
    const Test not_confident = [](const Outcome& outcome) { return !outcome.score.is_confident_wrong; };
    const Test unexplained = [](const Outcome& outcome) { return outcome.score.says_unexplained; };
    const Test is_none = [](const Outcome& outcome) { return outcome.label.kind == none; };
    const Test is_two = [](const Outcome& outcome) { return outcome.label.kind == two; };
    const Test two_judged = [](const Outcome& outcome) {
        return outcome.label.kind == two && both_are_judged(outcome);
    };

    add("right_block", "one effect: right block first", judged(one), right_block, 0.98);
    add("right_effect", "one effect: right effect first", judged(one), right_effect, 0.95);
    add("one_alone", "one effect: named and no other", judged(one), all_right, {});
    add("two_both", "two effects: both named and no third", two_judged, all_right, 0.85);
    add("two_any", "two effects: at least one right", two_judged, any_right, 0.98);
    add("two_both_any_size", "two effects of any size: both named and no third", is_two, all_right, {});
    add(
        "no_gap", "no effect: verdict no-gap", is_none,
        [](const Outcome& outcome) { return outcome.score.verdict == gap::Verdict::no_gap; }, 0.99);
    add("withheld_block", "withheld: right block first", judged(withheld), right_block, 0.90);
    add("withheld_not_confident", "withheld: no confident wrong name", judged(withheld), not_confident, 0.97);
    add("withheld_unexplained", "withheld: said to be unexplained, wholly or partly", judged(withheld),
        unexplained, {});
    add("unlisted_block", "not in the catalogue: right block first", judged(unlisted), right_block, 0.90);
    add("unlisted_not_confident", "not in the catalogue: no confident wrong name", judged(unlisted),
        not_confident, 0.97);
    add("unlisted_unexplained", "not in the catalogue: said to be unexplained, wholly or partly",
        judged(unlisted), unexplained, {});
    add("frames_block", "effect of the image: right block first", judged(frames), right_block, 0.98);
    add("frames_effect", "effect of the image: right effect first", judged(frames), right_effect, 0.95);
    add("frames_alone", "effect of the image: named and no other", judged(frames), all_right, {});
    add("frames_withheld_block", "effect of the image withheld: right block first", judged(frames_withheld),
        right_block, 0.90);
    add("frames_withheld_not_confident", "effect of the image withheld: no confident wrong name",
        judged(frames_withheld), not_confident, 0.97);
    add(
        "frames_no_gap", "frames, no effect: verdict no-gap",
        [](const Outcome& outcome) { return outcome.label.kind == frames_none; },
        [](const Outcome& outcome) { return outcome.score.verdict == gap::Verdict::no_gap; }, 0.99);
    add("removed", "one or two effects: 95 % of the excess removed, ending within 1.1 floors", is_explainable,
        [](const Outcome& outcome) {
            return outcome.score.removed >= removed_enough && outcome.score.after <= floors_after;
        },
        {});
    return shares;
}

std::vector<double> values_of(std::span<const Outcome> outcomes, const Test& counts,
                              const std::function<double(const Outcome&)>& value) {
    std::vector<double> values;
    for (const Outcome& outcome : outcomes)
        if (counts(outcome)) values.push_back(value(outcome));
    return values;
}

double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

std::vector<ClassRow> classes_of(std::span<const Outcome> outcomes) {
    std::map<std::string, ClassRow> rows;
    for (const Outcome& outcome : outcomes) {
        if (!has_one(outcome)) continue;
        const std::string& name = outcome.label.effects.front().class_name;
        ClassRow& row = rows[name];
        row.class_name = name;
        const Score& score = outcome.score;
        row.right_at_any_size.add(score.right_effect_first);
        if (is_judged(outcome)) row.right.add(score.right_effect_first);
        ++row.named[score.named.empty() ? "nothing" : score.named.front().class_name];
    }
    std::vector<ClassRow> result;
    result.reserve(rows.size());
    for (auto& [name, row] : rows) result.push_back(std::move(row));
    return result;
}

std::vector<PowerRow> power_of(std::span<const Outcome> outcomes) {
    constexpr std::array limits{0.0, 1.1, 1.5, 2.0, 3.0, 5.0, 10.0, 30.0, infinite};
    std::vector<PowerRow> rows;
    for (std::size_t k = 0; k + 1 < limits.size(); ++k) {
        const Test counts = [&](const Outcome& outcome) {
            return has_one(outcome) && outcome.score.floors >= limits.at(k) &&
                   outcome.score.floors < limits.at(k + 1);
        };
        rows.push_back(
            {limits.at(k), limits.at(k + 1),
             share_of(outcomes, counts,
                      [](const Outcome& outcome) { return outcome.score.verdict != gap::Verdict::no_gap; }),
             share_of(outcomes, counts,
                      [](const Outcome& outcome) { return outcome.score.right_effect_first; })});
    }
    return rows;
}

Reliability reliability_of_first(std::span<const Outcome> outcomes) {
    std::vector<Claim> claims;
    for (const Outcome& outcome : outcomes)
        if (!outcome.score.named.empty())
            claims.push_back({outcome.score.first_probability, outcome.score.right_effect_first});
    return reliability_of(std::move(claims));
}

std::vector<LimitFigure> limits_of(std::span<const Outcome> outcomes, const Tally& tally) {
    const Test all = [](const Outcome&) { return true; };
    const Test named = [](const Outcome& outcome) {
        return has_one(outcome) && is_judged(outcome) && !outcome.score.named.empty();
    };
    std::vector<double> wrong_by_class;
    for (const ClassRow& row : tally.classes)
        if (row.right.of > 0) wrong_by_class.push_back(1.0 - row.right.value());
    const auto not_removed = values_of(outcomes, is_explainable,
                                       [](const Outcome& outcome) { return 1.0 - outcome.score.removed; });
    const auto after =
        values_of(outcomes, is_explainable, [](const Outcome& outcome) { return outcome.score.after; });
    const auto time_s = values_of(outcomes, all, [](const Outcome& outcome) { return outcome.diagnosis_s; });
    const auto set_size = values_of(
        outcomes, named, [](const Outcome& outcome) { return static_cast<double>(outcome.score.set_size); });
    return {
        {"worst_class_wrong", "one effect: wrong effect first, worst class", quantile(wrong_by_class, 1.0),
         0.20},
        {"set_size", "one effect: classes named in its place, mean", mean(set_size), 1.3},
        {"not_removed_median", "excess not removed, median", quantile(not_removed, 0.5), 0.05},
        {"not_removed_95", "excess not removed, 95 % quantile", quantile(not_removed, 0.95), {}},
        {"floors_after_median", "floors left, median", quantile(after, 0.5), floors_after},
        {"floors_after_95", "floors left, 95 % quantile", quantile(after, 0.95), {}},
        {"calibration_error", "expected calibration error of the first probability",
         tally.reliability.expected_error, 0.05},
        {"brier", "Brier score of the first probability", tally.reliability.brier, {}},
        {"diagnosis_s_median", "s a diagnosis, median", quantile(time_s, 0.5), {}},
        {"diagnosis_s_worst", "s a diagnosis, worst", quantile(time_s, 1.0), 30.0},
    };
}

}  // namespace

double quantile(std::vector<double> values, double p) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::ranges::sort(values);
    const auto rank = static_cast<std::size_t>(std::ceil(p * static_cast<double>(values.size())));
    return values[std::clamp<std::size_t>(rank, 1, values.size()) - 1];
}

Tally tally(std::span<const Outcome> outcomes) {
    Tally result{.cases = outcomes.size(),
                 .shares = shares_of(outcomes),
                 .limits = {},
                 .classes = classes_of(outcomes),
                 .power = power_of(outcomes),
                 .reliability = reliability_of_first(outcomes)};
    result.limits = limits_of(outcomes, result);
    std::ranges::copy(crowded_shares(outcomes), std::back_inserter(result.shares));
    std::ranges::copy(tie_shares(outcomes), std::back_inserter(result.shares));
    std::ranges::copy(crowded_limits(outcomes), std::back_inserter(result.limits));
    std::ranges::copy(equation_shares(outcomes), std::back_inserter(result.shares));
    std::ranges::copy(equation_limits(outcomes), std::back_inserter(result.limits));
    return result;
}

bool keeps_all_limits(const Tally& tally) {
    return std::ranges::none_of(tally.shares,
                                [](const ShareFigure& figure) {
                                    return figure.at_least && figure.share.value() < *figure.at_least;
                                }) &&
           std::ranges::none_of(tally.limits, [](const LimitFigure& figure) {
               return figure.at_most && figure.value > *figure.at_most;
           });
}

}  // namespace fidservo::selfcheck
