// SPDX-License-Identifier: GPL-3.0-or-later
// Experiments designed for what recordings leave open.
#include "src/design/design_experiment.h"

#include "plant/effects/catalogue.h"
#include "src/simulation/simulate.h"
#include "tests/diagnose/tied.h"
#include "tests/reference_rig.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace fidservo::design {
namespace {

using fidservo::testing::tied;

gap::Evidence recorded(const gap::Hypothesis& truth, std::string_view kind) {
    const Experiment experiment = make_experiment(kind, reference_rig(), 1, "recorded");
    return gap::Evidence(reference_rig(), {simulate(reference_rig(), truth, experiment, "recorded", 1)});
}

TEST(OpenQuestion, PlainerForm_IsAskedAboutOneWay) {
    const gap::Diagnosis diagnosis = tied("coulomb_friction:level_V=0.05", "presliding:level_V=0.05");
    const gap::Evidence evidence = recorded(diagnosis.hypothesis, "macro-square");
    const OpenQuestion question = open_question(evidence, diagnosis);
    ASSERT_EQ(question.duels.size(), 1U);
    EXPECT_EQ(question.explanations[question.duels.front().truth].name, "presliding");
    EXPECT_EQ(question.separates, (std::vector<std::string>{"coulomb_friction", "presliding"}));
    for (const Explanation& explanation : question.explanations) EXPECT_FALSE(explanation.draws.empty());
}

TEST(OpenQuestion, NothingTied_IsNone) {
    gap::Diagnosis diagnosis;
    diagnosis.hypothesis = {plant::parse_effect("drive_gain:factor=0.9")};
    EXPECT_FALSE(open_question(recorded(diagnosis.hypothesis, "macro-sweep"), diagnosis).is_open());
}

TEST(SlowDesignExperiment, DecidesWhatTheListCannot_AndTheSameWayEachTime) {
    const gap::Diagnosis diagnosis =
        tied("coulomb_friction:level_V=0.05,dead_zone_share=0", "presliding:level_V=0.05,distance_um=1");
    const gap::Evidence evidence = recorded(diagnosis.hypothesis, "macro-pulses");
    const OpenQuestion question = open_question(evidence, diagnosis);
    const auto budget = std::make_shared<const gap::Budget>();
    const Judge judge(reference_rig(), question, {}, budget);
    constexpr DesignEffort few{16, 1, {0, 12}};
    const DesignedExperiment designed = design_experiment(judge, "designed", budget, few);
    ASSERT_TRUE(designed.best.has_value());
    const auto listed = best_of_list(judge, designed.decidable);
    ASSERT_TRUE(listed.has_value());
    RecordProperty("designed", std::to_string(designed.best->judgement.value));
    RecordProperty("listed", std::to_string(listed->judgement.value));
    EXPECT_GE(designed.best->judgement.value, least_log_odds);
    EXPECT_LT(listed->judgement.value, least_log_odds);
    EXPECT_LE(duration_s(designed.best->design), longest_s + 1e-9);
    const DesignedExperiment again = design_experiment(judge, "designed", budget, few);
    EXPECT_EQ(again.best->design, designed.best->design);
}

TEST(DesignExperiment, InterruptedAtOnce_GivesNone) {
    gap::Diagnosis diagnosis = tied("drive_gain:factor=0.99", "viscous_friction:damping_V_s_per_mm=0.0001");
    const OpenQuestion question = open_question(recorded(diagnosis.hypothesis, "macro-pulses"), diagnosis);
    const auto budget = std::make_shared<const gap::Budget>(100.0, 100.0, [] { return true; });
    const DesignedExperiment designed =
        design_experiment(Judge(reference_rig(), question, {}, budget), "designed", budget);
    EXPECT_FALSE(designed.best.has_value());
    EXPECT_EQ(designed.ended, gap::Ended::interrupted);
}

TEST(Judge, WhatRecordWouldRefuse_IsRefused) {
    const OpenQuestion question = open_question(recorded({}, "macro-pulses"), {});
    const Judge judge(reference_rig(), question, 60.0, {});
    Design runaway{10.0, {{.duration_s = 5.0, .value = 5.0}}, {}};
    EXPECT_TRUE(
        judge.judge(experiment_of(rounded(runaway, reference_rig()), "runaway", reference_rig()), {2, 1})
            .refused.has_value());
    const double limit_V = reference_rig().micro->heater.limit_V;
    Design hot{100.0, {}, {{.duration_s = 20.0, .value = limit_V}}};
    EXPECT_TRUE(judge.judge(experiment_of(rounded(hot, reference_rig()), "hot", reference_rig()), {2, 1})
                    .refused.has_value());
}

}  // namespace
}  // namespace fidservo::design
