// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics of hand-made outcomes.
#include "src/selfcheck/tally/tally.h"

#include "src/selfcheck/tally/tally_text.h"
#include "src/selfcheck/tally_json.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fidservo::selfcheck {
namespace {

using ::testing::HasSubstr;

Outcome outcome(CaseKind kind, double floors, bool right) {
    Outcome result;
    result.label.kind = kind;
    if (kind != CaseKind::none)
        result.label.effects = {{.effect = "cogging",
                                 .class_name = "cogging",
                                 .block = "macro.mechanics",
                                 .formula = "",
                                 .size = 0.1,
                                 .expected_floors = floors}};
    result.score.floors = floors;
    result.score.verdict = right ? gap::Verdict::explained : gap::Verdict::no_gap;
    if (right)
        result.score.named = {{.effect = "cogging",
                               .class_name = "cogging",
                               .is_true = true,
                               .probability = 0.9,
                               .gap_before = floors,
                               .gap_after = 1.0}};
    result.score.right_block_first = result.score.right_effect_first = right;
    result.score.any_right = result.score.all_right = right;
    result.score.first_probability = right ? 0.9 : 0.0;
    result.score.set_size = right ? 1 : 0;
    result.score.removed = right ? 0.99 : 0.0;
    result.score.after = right ? 1.0 : floors;
    result.diagnosis_s = floors;
    return result;
}

const ShareFigure& share(const Tally& tally, std::string_view name) {
    return *std::ranges::find(tally.shares, name, &ShareFigure::name);
}

double value(const Tally& tally, std::string_view name) {
    return std::ranges::find(tally.limits, name, &LimitFigure::name)->value;
}

TEST(Tally, SmallEffects_AreCountedInPowerOnly) {
    const std::vector<Outcome> outcomes{outcome(CaseKind::one, 1.2, false), outcome(CaseKind::one, 4.0, true),
                                        outcome(CaseKind::one, 4.0, true),
                                        outcome(CaseKind::one, 40.0, false)};
    const Tally got = tally(outcomes);
    EXPECT_EQ(share(got, "right_effect").share.hits, 2u);
    EXPECT_EQ(share(got, "right_effect").share.of, 3u);
    EXPECT_EQ(share(got, "one_alone").share.hits, 2u);
    ASSERT_EQ(got.classes.size(), 1u);
    EXPECT_EQ(got.classes.front().right.of, 3u);
    EXPECT_EQ(got.classes.front().right_at_any_size.of, 4u);
    EXPECT_EQ(got.classes.front().named.at("cogging"), 2u);
    EXPECT_EQ(got.classes.front().named.at("nothing"), 2u);
    EXPECT_NEAR(value(got, "worst_class_wrong"), 1.0 / 3.0, 1e-12);
    const auto row = std::ranges::find(got.power, 3.0, &PowerRow::from_floors);
    EXPECT_EQ(row->found.hits, 2u);
    EXPECT_EQ(row->right.of, 2u);
    EXPECT_EQ(value(got, "diagnosis_s_worst"), 40.0);
    EXPECT_FALSE(keeps_all_limits(got));
}

TEST(Tally, RemovedAndCalibration_AreOfTheRightCases) {
    std::vector<Outcome> outcomes(19, outcome(CaseKind::one, 5.0, true));
    outcomes.push_back(outcome(CaseKind::two, 5.0, false));
    outcomes.push_back(outcome(CaseKind::withheld, 5.0, false));
    const Tally got = tally(outcomes);
    EXPECT_EQ(share(got, "removed").share.hits, 19u);
    EXPECT_EQ(share(got, "removed").share.of, 20u);
    EXPECT_NEAR(value(got, "not_removed_median"), 0.01, 1e-12);
    EXPECT_NEAR(value(got, "calibration_error"), 0.1, 1e-12);  // 0.9 claimed, always right
    EXPECT_NEAR(value(got, "brier"), 0.01, 1e-12);
}

TEST(Tally, MessyRigs_AreJudgedByTheirDominantEffect) {
    Outcome first = outcome(CaseKind::messy, 50.0, true), second = first, none = first;
    first.score.dominant_place = 0;
    first.score.removed_of_true = 0.9;
    second.score.named.insert(second.score.named.begin(), second.score.named.front());
    second.score.named.front().is_true = false;
    second.score.named.back().probability = 0.3;
    second.score.dominant_place = 1;
    second.score.removed_of_true = 0.7;
    second.score.is_confident_wrong = true;
    none.label.kind = CaseKind::messy_none;
    none.score.named.front().is_true = false;
    const Tally got = tally(std::vector{first, second, none});
    EXPECT_EQ(share(got, "messy_dominant").share.hits, 2u);
    EXPECT_EQ(share(got, "messy_dominant_first").share.hits, 1u);
    EXPECT_EQ(share(got, "messy_dominant_likely").share.hits, 1u);
    EXPECT_EQ(share(got, "messy_not_confident").share.hits, 1u);
    EXPECT_EQ(share(got, "messy_not_confident").share.of, 2u);
    EXPECT_EQ(share(got, "messy_none_names_true").share.of, 1u);
    EXPECT_EQ(share(got, "messy_none_names_true").share.hits, 0u);
    EXPECT_EQ(value(got, "messy_dominant_probability"), 0.3);
    EXPECT_NEAR(value(got, "messy_not_removed"), 0.2, 1e-12);
    // Of three claims of 0.9, 0.9 and 0.3 two are true.
    EXPECT_NEAR(value(got, "messy_calibration_error"), 0.7 - 2.0 / 3.0, 1e-12);
    EXPECT_FALSE(keeps_all_limits(got));
}

TEST(Tally, RoughRigs_AreJudgedByBothEffects) {
    Outcome both = outcome(CaseKind::rough, 500.0, true), one = both,
            other = outcome(CaseKind::messy, 50.0, true);
    both.score.dominant_place = 0;
    both.score.truths_named = 2;
    one.score.truths_named = 1;
    one.score.named.front().is_true = false;
    one.score.is_confident_wrong = true;
    const Tally got = tally(std::vector{both, one, other});
    EXPECT_EQ(share(got, "rough_dominant_first").share.hits, 1u);
    EXPECT_EQ(share(got, "rough_all").share.hits, 1u);
    EXPECT_EQ(share(got, "rough_not_confident").share.hits, 1u);
    EXPECT_EQ(share(got, "rough_not_confident").share.of, 2u);
    // Of two claims of 0.9 one is true.
    EXPECT_NEAR(value(got, "rough_calibration_error"), 0.4, 1e-12);
}

TEST(Tally, ThreeEffects_CountWhereEachShows) {
    Outcome all = outcome(CaseKind::three, 5.0, true), two = all, small = all;
    all.score.truths_named = 3;
    two.score.truths_named = 2;
    small.label.effects.front().expected_floors = 1.0;
    const Tally got = tally(std::vector{all, two, small});
    EXPECT_EQ(share(got, "three_all").share.hits, 1u);
    EXPECT_EQ(share(got, "three_all").share.of, 2u);
    EXPECT_EQ(share(got, "three_two").share.hits, 2u);
    EXPECT_EQ(share(got, "three_all_any_size").share.of, 3u);
}

TEST(Tally, NamesInTheJson_HaveWhatACalibrationNeeds) {
    const std::vector<Outcome> outcomes{outcome(CaseKind::messy, 40.0, true)};
    const auto json = nlohmann::json::parse(self_check_json({}, {outcomes, {}, false}, tally(outcomes)));
    const auto& named = json["cases"][0]["found"][0];
    EXPECT_EQ(named["effect"], "cogging");
    EXPECT_EQ(named["true"], true);
    EXPECT_EQ(named["probability"], 0.9);
    EXPECT_EQ(named["gap"]["before"], 40.0);
    EXPECT_EQ(named["gap"]["after"], 1.0);
    EXPECT_TRUE(json["cases"][0].contains("floors_left"));
}

TEST(Tally, FalseAlarm_MissesItsLimitAndSilenceKeepsAll) {
    Outcome alarm = outcome(CaseKind::none, 1.0, true);
    EXPECT_FALSE(keeps_all_limits(tally(std::vector{alarm})));
    EXPECT_TRUE(keeps_all_limits(tally(std::vector{outcome(CaseKind::none, 1.0, false)})));
    EXPECT_TRUE(keeps_all_limits(tally({})));
}

TEST(SelfCheck, CaseThatFailed_IsSaidInItsTurn) {
    Outcome first = outcome(CaseKind::one, 4.0, true), third = first;
    first.number = 1;
    third.number = 3;
    EXPECT_THAT(line_of_last({{first}, {{2, "no memory"}}, false}),
                HasSubstr("case    2 could not be diagnosed"));
    EXPECT_EQ(line_of_last({{first, third}, {{2, "no memory"}}, false}), line_of(third));
    SelfCheckOptions three;
    three.cases = 3;
    const auto is_unfinished = [&](const SelfCheck& check) {
        return nlohmann::json::parse(self_check_json(three, check, tally(check.outcomes)))["interrupted"];
    };
    EXPECT_EQ(is_unfinished({{first}, {{2, "no memory"}}, false}), true);
    EXPECT_EQ(is_unfinished({{first, third}, {{2, "no memory"}}, false}), false);
}

TEST(Tally, TextAndJson_SayTheSame) {
    const std::vector<Outcome> outcomes{outcome(CaseKind::one, 4.0, true),
                                        outcome(CaseKind::none, 1.0, false)};
    const Tally got = tally(outcomes);
    EXPECT_THAT(text_of(got), HasSubstr("one effect: right effect first"));
    EXPECT_THAT(text_of(got), HasSubstr("1 of 1"));
    SelfCheckOptions options;
    options.seed = 3;
    const auto json = nlohmann::json::parse(self_check_json(options, {outcomes, {}, false}, got));
    EXPECT_EQ(json["format"], "fidservo-self-check/1");
    EXPECT_EQ(json["options"]["seed"], 3);
    EXPECT_EQ(json["figures"]["right_effect"]["hits"], 1);
    EXPECT_EQ(json["figures"]["no_gap"]["share"], 1.0);
    EXPECT_EQ(json["cases"].size(), 2u);
    EXPECT_EQ(json["cases"][0]["effects"][0]["effect"], "cogging");
    EXPECT_TRUE(json["figures"]["two_both"]["share"].is_null());
}

TEST(Quantile, SmallList_IsTheValueByRank) {
    EXPECT_EQ(quantile({3.0, 1.0, 2.0, 4.0}, 0.5), 2.0);
    EXPECT_EQ(quantile({3.0, 1.0, 2.0, 4.0}, 1.0), 4.0);
    EXPECT_EQ(quantile({3.0, 1.0, 2.0, 4.0}, 0.05), 1.0);
    EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

}  // namespace
}  // namespace fidservo::selfcheck
