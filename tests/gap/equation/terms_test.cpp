// SPDX-License-Identifier: GPL-3.0-or-later
// The library of terms, and what sparse regression makes of a force that is known.
#include "gap/equation/screening.h"
#include "gap/evidence/halves.h"
#include "plant/formulas/formula_effect.h"
#include "tests/gap/hidden_formula.h"
#include "tests/gap/simulated_campaign.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::gap {
namespace {

const CoveredRanges some_ranges{{0.0, 20.0},   {-4.0, 4.0},  {20.0, 180.0}, {-200.0, 200.0},
                                {0.0, 1000.0}, {22.0, 90.0}, {0.0, 3.8},    {0.0, 150.0},
                                {0.0, 1.9},    {0.0, 190.0}, {20.0, 180.0}};

void expect_that_all_can_be_evaluated(const CoveredRanges& ranges) {
    const std::vector<double> periods_mm{5.0, 12.0};
    for (const plant::PortDescription& port : plant::ports()) {
        const std::vector<Term> terms = terms_of(port.port, ranges, periods_mm);
        EXPECT_FALSE(terms.empty()) << port.name;
        for (const Term& term : terms) {
            EXPECT_GT(term.size, 0.0);
            EXPECT_FALSE(term.words.empty());
            for (std::size_t text = 0; text < term.texts.size(); ++text) {
                const FormulaEffect effect =
                    formula_of(one_text_of(port.port, term, text, 1.0), port.blocks.front(), "of_test");
                EXPECT_NO_THROW((void)plant::effect_of(effect)) << port.name << ": " << term.texts[text];
            }
        }
    }
}

TEST(EquationTerms, OfEveryPort_CanBeEvaluatedThere) {
    expect_that_all_can_be_evaluated(some_ranges);
}

TEST(EquationTerms, OfVariablesThatDidNotVary_CanBeEvaluatedThere) {
    expect_that_all_can_be_evaluated(CoveredRanges{});
}

/// A term's expression, to compare with.
std::vector<std::string> texts_of(const Sketch& sketch) {
    std::vector<std::string> texts;
    for (const Term& term : sketch.terms) texts.insert(texts.end(), term.texts.begin(), term.texts.end());
    return texts;
}

PortScreening screening(const Evidence& evidence, const Errors& errors, plant::Port port) {
    return {evidence, {}, errors, port, terms_of(port, covered_ranges(evidence), {})};
}

TEST(EquationScreening, DragOfACarriage_IsTakenInWithItsCoefficientAndNothingBeside) {
    const Evidence evidence = testing::campaign(
        {testing::hidden_formula("macro.friction", "macro.friction", "size * speed * abs(speed)", 4e-6)},
        {"macro-pulses", "macro-sweep"});
    const Errors errors = evidence.errors({}, everything(evidence));
    const auto sketch = screening(evidence, errors, plant::Port::friction).sketch(0.01);
    ASSERT_TRUE(sketch.has_value());
    EXPECT_THAT(texts_of(*sketch), ::testing::ElementsAre(::testing::HasSubstr("* abs(clip(speed")));
    EXPECT_NEAR(sketch->coefficients.front(), 4e-6, 0.4e-6);
}

TEST(EquationScreening, RigWithoutAGap_HasNoTermAtAnyPortOfTheCarriage) {
    const Evidence evidence = testing::campaign({}, {"macro-pulses", "macro-sweep"});
    const Errors errors = evidence.errors({}, everything(evidence));
    for (const plant::Port port : {plant::Port::force, plant::Port::friction, plant::Port::drive_voltage})
        EXPECT_FALSE(screening(evidence, errors, port).sketch(0.01).has_value());
}

TEST(EquationScreening, LatentHeat_IsTakenInWhereTheWireIsHeated) {
    const Evidence evidence = testing::campaign(
        {testing::hidden_formula("micro.heat_flow", "micro.heater", "size * contraction_rate", -0.5)},
        {"micro-steps", "micro-triangle"});
    const Errors errors = evidence.errors({}, everything(evidence));
    const auto sketch = screening(evidence, errors, plant::Port::heat_flow).sketch(0.01);
    ASSERT_TRUE(sketch.has_value());
    EXPECT_EQ(texts_of(*sketch).front(), "contraction_rate");
    EXPECT_NEAR(sketch->coefficients.front(), -0.5, 0.15);
}

}  // namespace
}  // namespace fidservo::gap
