// SPDX-License-Identifier: GPL-3.0-or-later
// The experiment that decides between causes that are tied.
#include "src/diagnose/next_experiment.h"

#include "plant/effects/catalogue.h"
#include "src/simulation/experiments.h"
#include "tests/diagnose/tied.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using fidservo::testing::tied;

TEST(NextExperiment, OfTwoCausesInTheDrive_MovesTheCarriage_AndTakesHalfAMinuteAtMost) {
    const auto proposed = diagnose::next_experiment(
        reference_rig(), tied("drive_gain:factor=0.99", "viscous_friction:damping_V_s_per_mm=0.0001"));
    ASSERT_TRUE(proposed.has_value());
    EXPECT_TRUE(proposed->experiment.starts_with("macro-") || proposed->experiment == "integrated")
        << proposed->experiment;
    EXPECT_LE(make_experiment(proposed->experiment, reference_rig(), 1, "next").duration_s, 30.0);
    EXPECT_EQ(proposed->separates, (std::vector<std::string>{"drive_gain", "viscous_friction"}));
}

TEST(NextExperiment, CausesThatNoDataTellApart_AndNoTie_LeadToNone) {
    EXPECT_FALSE(diagnose::next_experiment(
                     reference_rig(), tied("ambient_temperature:shift_degC=3", "stress_shift:shift_degC=3"))
                     .has_value());
    EXPECT_FALSE(diagnose::next_experiment(reference_rig(), gap::Diagnosis{}).has_value());
}

TEST(NextExperiment, RivalThatWasFoundAsWell_IsNone) {
    gap::Diagnosis both = tied("drive_gain:factor=0.99", "viscous_friction:damping_V_s_per_mm=0.0001");
    both.hypothesis.push_back(both.effects.front().rivals.front());
    both.effects.push_back(both.effects.front());
    both.effects.back().effect = "viscous_friction";
    both.effects.back().rivals.clear();
    EXPECT_FALSE(diagnose::next_experiment(reference_rig(), both).has_value());
}

}  // namespace

}  // namespace fidservo
