// SPDX-License-Identifier: GPL-3.0-or-later
// An equation against wrong names, and in addition to right names.
#include "gap/diagnose.h"
#include "tests/gap/hidden_formula.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace fidservo::gap {
namespace {

plant::EffectSetting drag(double V_s2_per_mm2) {
    return testing::hidden_formula("macro.friction", "macro.friction", "size * speed * abs(speed)",
                                   V_s2_per_mm2);
}

Diagnosis diagnosed(const Evidence& evidence, std::vector<std::string> only) {
    constexpr double as_long_as_it_takes_s = 600.0;
    const auto budget = std::make_shared<const Budget>(as_long_as_it_takes_s, as_long_as_it_takes_s,
                                                       std::function<bool()>{}, Seconds::by_effort);
    const Evidence limited(evidence.rig(), evidence.recordings(), budget);
    return diagnose(
        limited,
        {.only = std::move(only), .without = {}, .equation_s = as_long_as_it_takes_s, .selection = {}});
}

/// Damping and a constant friction approximate drag, and are named where only they are allowed; the formula
/// predicts better than both, and their probabilities are reduced.
TEST(SlowEquation, LawThatPredictsBetterThanWrongNames_TakesTheirPlace) {
    const Evidence evidence = testing::campaign({drag(4e-6)}, {"macro-pulses", "macro-sweep"});
    const Diagnosis diagnosis = diagnosed(evidence, {"coulomb_friction", "viscous_friction"});
    ASSERT_FALSE(diagnosis.effects.empty());
    ASSERT_TRUE(diagnosis.unexplained && diagnosis.unexplained->equation);
    const Equation& equation = *diagnosis.unexplained->equation;
    EXPECT_TRUE(equation.in_place_of_names);
    EXPECT_EQ(equation.acts_on, "macro.friction");
    EXPECT_GT(equation.gap_removed, 0.95);
    for (const FoundEffect& found : diagnosis.effects) EXPECT_LT(found.probability, 0.05) << found.effect;
    ASSERT_FALSE(diagnosis.where.empty());
    EXPECT_EQ(diagnosis.where.front().block, "macro.friction");
    EXPECT_GT(diagnosis.where.front().probability, 0.9);
}

/// A right name remains, and the formula is found in addition.
TEST(SlowEquation, LawBesideANameThatIsRight_LeavesTheName) {
    Hypothesis truth = testing::effects({"drive_gain:factor=0.9"});
    truth.push_back(drag(4e-6));
    const Evidence evidence = testing::campaign(truth, {"macro-pulses", "macro-sweep"});
    const Diagnosis diagnosis = diagnosed(evidence, {"drive_gain"});
    ASSERT_EQ(diagnosis.effects.size(), 1U);
    ASSERT_TRUE(diagnosis.unexplained && diagnosis.unexplained->equation);
    EXPECT_FALSE(diagnosis.unexplained->equation->in_place_of_names);
    const Equation& equation = *diagnosis.unexplained->equation;
    EXPECT_GT(equation.gap_removed, 0.99);
    EXPECT_NEAR(equation.parameters.at(0).value, 4e-6, 0.1e-6);
    EXPECT_EQ(diagnosis.unexplained->block, equation.setting.effect->block);
    EXPECT_FALSE(diagnosis.unexplained->depends_on.empty());
    const FittedParameter& factor = diagnosis.effects.front().parameters.at(0);
    EXPECT_NEAR(factor.value, 0.9, 0.01) << "beside the law, the gain makes up for nothing";
}

/// The tags alone are off, as if the encoder read falsely; its own signal says that it does not.
TEST(SlowEquation, WaveAlongTheCamerasWay_IsProposedThere) {
    const Evidence evidence =
        testing::campaign({testing::hidden_formula("camera.x", "camera.geometry",
                                                   "size * sin(2 * pi * camera_place / 12)", 0.1)},
                          {"macro-pulses", "macro-square", "macro-sweep", "micro-steps", "integrated"});
    const Diagnosis diagnosis = diagnosed(evidence, {"encoder_ripple"});
    EXPECT_TRUE(diagnosis.effects.empty());
    ASSERT_TRUE(diagnosis.unexplained && diagnosis.unexplained->equation);
    EXPECT_EQ(diagnosis.unexplained->equation->acts_on, "camera.x");
    EXPECT_GT(diagnosis.unexplained->equation->gap_removed, 0.99);
    EXPECT_EQ(diagnosis.unexplained->block, "camera.geometry");
}

}  // namespace
}  // namespace fidservo::gap
