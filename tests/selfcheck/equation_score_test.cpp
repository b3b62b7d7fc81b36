// SPDX-License-Identifier: GPL-3.0-or-later
// A proposed equation compared with the right one.
#include "src/selfcheck/tally/equation_score.h"

#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"
#include "src/files/rig/rig_file.h"
#include "src/selfcheck/draw/campaign.h"
#include "src/selfcheck/tally/equation_figures.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::selfcheck {
namespace {

FormulaEffect text_of(const std::string& acts_on, const std::string& block, const std::string& formula) {
    FormulaEffect text;
    text.name = "of_test";
    text.acts_on = acts_on;
    text.block = block;
    text.formula = "whole * (" + formula + ")";
    text.parameters.push_back({.name = "whole", .low = 0.0, .high = 2.0, .typical = 1.0});
    return text;
}

gap::Diagnosis proposing(const FormulaEffect& text) {
    gap::Diagnosis diagnosis;
    diagnosis.verdict = gap::Verdict::unexplained;
    gap::Equation equation{.acts_on = text.acts_on,
                           .formula = text.formula,
                           .variables = {},
                           .parameters = {},
                           .gap_removed = 0.9,
                           .gap_removed_low = 0.8,
                           .gap_removed_high = 1.0,
                           .text = "",
                           .setting = plant::typical_setting(plant::effect_of(text))};
    diagnosis.unexplained =
        gap::Remainder{.block = text.block, .depends_on = {}, .text = "", .equation = equation};
    return diagnosis;
}

const gap::Evidence& evidence() {
    static const gap::Evidence made = [] {
        const Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
        return gap::Evidence(rig, {record_run(rig, {rig, {}}, {"integrated", "integrated-1"}, 3)});
    }();
    return made;
}

TEST(EquationScore, TheSameLawAtAnotherPortOfTheCarriage_IsOfTheRightForm) {
    const EquationScore score =
        score_equation(text_of("macro.friction", "macro.friction", "0.002 * speed"),
                       proposing(text_of("macro.force", "macro.friction", "-0.00204 * speed")), evidence());
    EXPECT_TRUE(score.right_variables);
    EXPECT_NEAR(score.apart, 0.02, 1e-6);
    EXPECT_EQ(score.removed, 0.9);
}

TEST(EquationScore, AnotherFunctionOfTheSameVariable_IsNot) {
    const EquationScore score =
        score_equation(text_of("macro.friction", "macro.friction", "0.002 * speed"),
                       proposing(text_of("macro.friction", "macro.friction", "0.1 * direction")), evidence());
    EXPECT_FALSE(score.right_variables);
    EXPECT_GT(score.apart, right_form);
}

TEST(EquationScore, AnotherQuantity_HasNothingInCommon) {
    const EquationScore score =
        score_equation(text_of("micro.transformation", "micro.hysteresis", "2"),
                       proposing(text_of("micro.contraction", "micro.hysteresis", "2")), evidence());
    EXPECT_EQ(score.apart, 1.0);
}

/// A heating power acts with the time constant of the regime, so that it can be converted to a heating rate.
TEST(EquationScore, PowerAndFlowOfHeat_AreCompared) {
    const Rig& rig = evidence().rig();
    const EquationScore score =
        score_equation(text_of("micro.heater_power", "micro.heater", "3"),
                       proposing(text_of("micro.heat_flow", "micro.heater",
                                         "heater_power > wire_temp - room_temp ? 3 / " +
                                             std::to_string(rig.micro->heater.heating_tau_s) + " : 3 / " +
                                             std::to_string(rig.micro->heater.cooling_tau_s))),
                       evidence());
    EXPECT_LT(score.apart, 1e-5);
}

TEST(EquationScore, PlaceThatTheEncoderReadsBeside_IsComparedWithoutMeans) {
    const EquationScore score = score_equation(
        text_of("macro.encoder", "macro.encoder", "1e-4 * (place - 100)^2"),
        proposing(text_of("macro.encoder", "macro.encoder", "1e-4 * (place - 100)^2 + 0.3")), evidence());
    EXPECT_LT(score.apart, 1e-9);
}

TEST(EquationFigures, OfTwoCases_CountThoseOfTenFloors) {
    Outcome right;
    right.label.kind = CaseKind::withheld;
    right.score.floors = 20.0;
    right.score.proposes_equation = true;
    right.score.equation = EquationScore{.acts_on = "macro.force",
                                         .formula = "a * place",
                                         .right_variables = true,
                                         .apart = 0.01,
                                         .removed = 0.97,
                                         .removed_of_kinds_left_out = 0.8};
    Outcome none = right;
    none.score.equation = EquationScore{};
    Outcome small = none;
    small.score.floors = 9.0;
    const std::vector<Outcome> outcomes{right, none, small};
    for (const ShareFigure& figure : equation_shares(outcomes)) {
        if (figure.name == "equation_none" || figure.name == "equation_beside") continue;
        EXPECT_EQ(figure.share.of, 2U) << figure.name;
        EXPECT_EQ(figure.share.hits, 1U) << figure.name;
    }
    const std::vector<LimitFigure> limits = equation_limits(outcomes);
    EXPECT_NEAR(limits.front().value, 0.03, 1e-12);
    EXPECT_NEAR(limits.back().value, 0.2, 1e-12);
}

}  // namespace
}  // namespace fidservo::selfcheck
