// SPDX-License-Identifier: GPL-3.0-or-later
// Drafts of formulas: written out, changed, joined.
#include "gap/equation/sketch.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

Term drag(int family = 1) {
    return {.texts = {"speed * abs(speed)"},
            .unit = "(mm/s)2",
            .size = 4e4,
            .shapes = {},
            .family = family,
            .words = "growing with the square of speed"};
}

Term wave(int family = 2) {
    return {.texts = {"sin(2 * pi * place / shape)", "cos(2 * pi * place / shape)"},
            .unit = "",
            .size = 1.0,
            .shapes = {{"mm", 5.0, 4.5, 5.5}},
            .family = family,
            .words = "a wave along the way, 5 mm long"};
}

const Sketch both{plant::Port::force, {drag(), wave()}, {1e-6, 0.02, -0.03}};

TEST(Sketch, IsWrittenAsAFormula_WithItsCoefficientsAndShapes) {
    const FormulaEffect formula = formula_of(both, "macro.mechanics", "unnamed_1");
    EXPECT_EQ(formula.name, "unnamed_1");
    EXPECT_EQ(formula.block, "macro.mechanics");
    EXPECT_EQ(formula.formula,
              "a * speed * abs(speed) + b * sin(2 * pi * place / p) + c * cos(2 * pi * place / p)");
    std::vector<std::string> names;
    for (const FormulaEffect::Parameter& parameter : formula.parameters) names.push_back(parameter.name);
    EXPECT_EQ(names, (std::vector<std::string>{"a", "b", "c", "p"}));
    EXPECT_DOUBLE_EQ(formula.parameters[2].typical, -0.03);
    EXPECT_LT(formula.parameters[2].low, -0.03);
    EXPECT_EQ(formula.parameters[3].role, "shape");
    EXPECT_EQ(formula.parameters[3].unit, "mm");
}

TEST(Sketch, GoesToABlockOfItsPort_WhereTheAccusedOneIsNone) {
    EXPECT_NE(formula_of(both, "camera.timing", "unnamed_1").block, "camera.timing");
}

TEST(Sketch, TakesValuesInTheOrderOfItsParameters) {
    const Sketch changed = with_values(both, std::vector{1.0, 2.0, 3.0, 5.2});
    EXPECT_EQ(changed.coefficients, (std::vector<double>{1.0, 2.0, 3.0}));
    EXPECT_DOUBLE_EQ(changed.terms[1].shapes.front().value, 5.2);
}

TEST(Sketch, WithoutATerm_KeepsTheCoefficientsOfTheOthers) {
    EXPECT_EQ(without(both, 0).coefficients, (std::vector<double>{0.02, -0.03}));
    EXPECT_EQ(without(both, 1).coefficients, (std::vector<double>{1e-6}));
    EXPECT_EQ(without(both, 1).terms.front().family, 1);
    EXPECT_EQ(first_of(both).coefficients, (std::vector<double>{1e-6}));
    EXPECT_EQ(both.shapes(), 1U);
    EXPECT_EQ(without(both, 1).shapes(), 0U);
}

TEST(Sketch, OfOneText_HasItsCoefficientAlone) {
    const Sketch one = one_text_of(plant::Port::force, wave(), 1, 0.5);
    EXPECT_EQ(one.terms.front().texts, (std::vector<std::string>{"cos(2 * pi * place / shape)"}));
    EXPECT_EQ(one.coefficients, (std::vector<double>{0.5}));
}

TEST(Sketch, JoinsAnother_UnlessATermIsInBothOrTheyAreTooMany) {
    const Sketch one{plant::Port::force, {drag()}, {1e-6}},
        other{plant::Port::force, {wave()}, {0.02, -0.03}};
    const auto together = joined(one, other);
    ASSERT_TRUE(together.has_value());
    EXPECT_EQ(together->coefficients, both.coefficients);
    EXPECT_FALSE(joined(both, other).has_value()) << "the wave is in both";
    const Sketch more{plant::Port::force, {wave(3)}, {0.1, 0.1}};
    EXPECT_FALSE(joined(both, more).has_value()) << "five coefficients";
}

}  // namespace
}  // namespace fidservo
