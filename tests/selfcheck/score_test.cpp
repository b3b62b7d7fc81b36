// SPDX-License-Identifier: GPL-3.0-or-later
// The scorer on diagnoses made by hand.
#include "src/selfcheck/tally/score.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::selfcheck {
namespace {

using gap::Diagnosis;
using gap::FoundEffect;
using gap::Verdict;

TrueEffect truth(const char* effect, const char* class_name, const char* block) {
    return {.effect = effect,
            .class_name = class_name,
            .block = block,
            .formula = "",
            .size = 1.0,
            .expected_floors = 5.0};
}

const TrueEffect cogging = truth("cogging", "cogging", "macro.mechanics");
const TrueEffect airflow = truth("airflow", "airflow", "micro.heater");
const TrueEffect stress = truth("stress_shift", "ambient_temperature", "micro.hysteresis");

FoundEffect found(const char* effect, const char* block, double probability,
                  std::vector<std::string> ties = {}) {
    return {.effect = effect,
            .block = block,
            .probability = probability,
            .parameters = {},
            .indistinguishable_from = std::move(ties),
            .gap_removed = 0.0,
            .gap_removed_low = 0.0,
            .gap_removed_high = 0.0};
}

Diagnosis diagnosis_of(Verdict verdict, std::vector<FoundEffect> effects) {
    Diagnosis diagnosis;
    diagnosis.verdict = verdict;
    for (const FoundEffect& effect : effects) diagnosis.where.push_back({effect.block, effect.probability});
    diagnosis.effects = std::move(effects);
    diagnosis.signals = {{gap::Signal::encoder, 1.5, 0.3, 0.3}, {gap::Signal::hall, 0.6, 0.5, 0.5}};
    diagnosis.gap.before = 3.0;
    diagnosis.gap.after = 1.0;
    return diagnosis;
}

TEST(Score, RightEffect_IsRightInBlockAndName) {
    const Score got = score({CaseKind::one, {cogging}},
                            diagnosis_of(Verdict::explained, {found("cogging", "macro.mechanics", 0.99)}));
    EXPECT_TRUE(got.right_block_first && got.right_effect_first && got.any_right && got.all_right);
    EXPECT_FALSE(got.is_confident_wrong || got.says_unexplained);
    EXPECT_EQ(got.floors, 5.0);
    EXPECT_EQ(got.first_probability, 0.99);
    EXPECT_EQ(got.set_size, 1u);
    EXPECT_DOUBLE_EQ(got.removed, 1.0);
}

TEST(Score, EffectsOfOneClass_CountAsOne) {
    const Diagnosis diagnosis = diagnosis_of(
        Verdict::explained, {found("ambient_temperature", "micro.heater", 0.99, {"stress_shift"})});
    const Score got = score({CaseKind::one, {stress}}, diagnosis);
    EXPECT_TRUE(got.right_block_first && got.right_effect_first && got.all_right);
    EXPECT_EQ(got.set_size, 1u);
}

TEST(Score, SetWithTheTruth_IsRightAndCountsItsClasses) {
    const Diagnosis diagnosis = diagnosis_of(
        Verdict::explained, {found("payload", "macro.mechanics", 0.6, {"cogging", "drive_gain"})});
    const Score got = score({CaseKind::one, {cogging}}, diagnosis);
    EXPECT_TRUE(got.right_effect_first && got.all_right);
    EXPECT_EQ(got.set_size, 3u);
    EXPECT_FALSE(score({CaseKind::one, {airflow}}, diagnosis).right_effect_first);
}

TEST(Score, WrongEffectOfTheRightBlock_IsRightInBlockOnly) {
    const Diagnosis diagnosis = diagnosis_of(Verdict::explained, {found("payload", "macro.mechanics", 0.95)});
    const Score got = score({CaseKind::one, {cogging}}, diagnosis);
    EXPECT_TRUE(got.right_block_first && got.is_confident_wrong);
    EXPECT_FALSE(got.right_effect_first || got.any_right || got.all_right);
}

TEST(Score, TwoEffects_AreAllRightOnlyWithoutAThird) {
    const Label label{CaseKind::two, {cogging, airflow}};
    const FoundEffect first = found("airflow", "micro.heater", 1.0);
    const FoundEffect second = found("cogging", "macro.mechanics", 1.0);
    const FoundEffect third = found("hall_gain", "micro.hall", 0.5);
    EXPECT_TRUE(score(label, diagnosis_of(Verdict::explained, {first, second})).all_right);
    const Score three = score(label, diagnosis_of(Verdict::explained, {first, second, third}));
    EXPECT_TRUE(three.any_right && three.right_effect_first);
    EXPECT_FALSE(three.all_right || three.is_confident_wrong);
    const Score half = score(label, diagnosis_of(Verdict::partly_explained, {third, second}));
    EXPECT_TRUE(half.any_right && half.says_unexplained);
    EXPECT_FALSE(half.all_right || half.right_effect_first);
}

TEST(Score, OneSetOverBothTruths_DoesNotStandForTwo) {
    const Label label{CaseKind::two, {cogging, airflow}};
    const FoundEffect both = found("cogging", "macro.mechanics", 0.5, {"airflow"});
    EXPECT_FALSE(score(label, diagnosis_of(Verdict::explained, {both})).all_right);
    EXPECT_TRUE(score(label, diagnosis_of(Verdict::explained, {both, found("cogging", "", 0.5)})).all_right);
}

TEST(Score, NoEffect_EveryNameIsWrong) {
    EXPECT_EQ(score({}, diagnosis_of(Verdict::no_gap, {})).verdict, Verdict::no_gap);
    const Score got =
        score({}, diagnosis_of(Verdict::explained, {found("cogging", "macro.mechanics", 0.99)}));
    EXPECT_TRUE(got.is_confident_wrong);
    EXPECT_FALSE(got.any_right || got.right_block_first);
}

TEST(Score, Withheld_AsksForTheBlockAndForNoSureName) {
    const Label label{CaseKind::withheld, {cogging}};
    Diagnosis open = diagnosis_of(Verdict::unexplained, {});
    open.where = {{"macro.mechanics", 1.0}};
    const Score good = score(label, open);
    EXPECT_TRUE(good.right_block_first && good.says_unexplained);
    EXPECT_FALSE(good.is_confident_wrong);
    const auto named = [&](double probability) {
        return score(label,
                     diagnosis_of(Verdict::explained, {found("payload", "macro.mechanics", probability)}));
    };
    EXPECT_TRUE(named(confident).is_confident_wrong);
    EXPECT_FALSE(named(confident - 0.01).is_confident_wrong);
    EXPECT_FALSE(named(0.95).right_effect_first);
}

TEST(Score, ThreeEffects_CountThoseThatHaveANameOfTheirOwn) {
    const TrueEffect payload = truth("payload", "payload", "macro.mechanics");
    const Label label{CaseKind::three, {cogging, airflow, payload}};
    const FoundEffect either = found("cogging", "macro.mechanics", 0.9, {"payload"});
    const FoundEffect second = found("cogging", "macro.mechanics", 0.9);
    const FoundEffect wrong = found("hall_gain", "micro.hall", confident_of_crowded);
    EXPECT_EQ(score(label, diagnosis_of(Verdict::explained, {either})).truths_named, 1u);
    EXPECT_EQ(score(label, diagnosis_of(Verdict::explained, {either, second})).truths_named, 2u);
    EXPECT_EQ(score(label, diagnosis_of(Verdict::explained, {second, second})).truths_named, 1u);
    const FoundEffect third = found("airflow", "micro.heater", 0.9);
    const Score all = score(label, diagnosis_of(Verdict::explained, {either, second, third}));
    EXPECT_EQ(all.truths_named, 3u);
    EXPECT_TRUE(all.all_right);
    const Score four = score(label, diagnosis_of(Verdict::explained, {either, second, third, wrong}));
    EXPECT_EQ(four.truths_named, 3u);
    EXPECT_TRUE(four.is_confident_wrong && !four.all_right);
}

TEST(Score, MessyRig_SaysWhereItsDominantEffectIsAndWhatIsRemoved) {
    Label label{CaseKind::messy, {stress, cogging}};
    label.discrepancy = TrueDiscrepancy{.block = "micro.hall", .depends_on = "time", .gap_floors = 2.0};
    FoundEffect first = found("cogging", "macro.mechanics", 0.8);
    first.gap_removed = 0.5;
    FoundEffect second = found("ambient_temperature", "micro.heater", 0.4);
    second.gap_removed = 0.75;
    Diagnosis diagnosis = diagnosis_of(Verdict::partly_explained, {first, second});
    diagnosis.gap = {.before = 3.0, .after = std::sqrt(3.0)};
    const Score got = score(label, diagnosis);
    EXPECT_EQ(got.dominant_place, 1u);
    ASSERT_EQ(got.named.size(), 2u);
    EXPECT_TRUE(got.named[0].is_true && got.named[1].is_true);
    EXPECT_EQ(got.named[1].probability, 0.4);
    // Of an excess of 8 a half and then three quarters are removed.
    EXPECT_DOUBLE_EQ(got.named[0].gap_before, 3.0);
    EXPECT_DOUBLE_EQ(got.named[0].gap_after, std::sqrt(5.0));
    EXPECT_DOUBLE_EQ(got.named[1].gap_before, std::sqrt(5.0));
    EXPECT_DOUBLE_EQ(got.named[1].gap_after, std::sqrt(3.0));
    // Without its effects the rig would be at 1 + 2^2: 4 can go, and more than that is gone.
    EXPECT_EQ(got.removed_of_true, 1.0);
    diagnosis.gap.after = std::sqrt(6.0);
    EXPECT_DOUBLE_EQ(*score(label, diagnosis).removed_of_true, 0.75);
    EXPECT_EQ(got.floors_left, 1.0);
}

TEST(Score, MessyRigWithoutDominantEffect_HasNone) {
    Label label{CaseKind::messy_none, {cogging}};
    const Score got =
        score(label, diagnosis_of(Verdict::explained, {found("cogging", "macro.mechanics", 0.8)}));
    EXPECT_TRUE(got.named.front().is_true);
    EXPECT_FALSE(got.is_confident_wrong || got.dominant_place || got.removed_of_true);
}

}  // namespace
}  // namespace fidservo::selfcheck
