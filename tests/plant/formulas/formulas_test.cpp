// SPDX-License-Identifier: GPL-3.0-or-later
// The contributions and memories of formulas, against closed forms.
#include "plant/formulas/formulas.h"

#include "core/input_error.h"
#include "tests/plant/formulas/texts.h"

#include <array>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

using Kind = FormulaEffect::Memory::Kind;
constexpr double tick_s = 0.001;

Formulas formulas_of(const FormulaEffect& text) {
    std::vector<double> values;
    for (const FormulaEffect::Parameter& parameter : text.parameters) values.push_back(parameter.typical);
    Formulas formulas;
    formulas.add(FormulaCode::of(text), values);
    return formulas;
}

std::array<double, carriage_variable::count> at_speed(double mm_per_s) {
    std::array<double, carriage_variable::count> variables{};
    variables[carriage_variable::speed] = mm_per_s;
    return variables;
}

/// A friction that depends on a quantity with memory.
FormulaEffect remembering(Kind kind, const std::string& of, const std::string& by = {}) {
    FormulaEffect text =
        formula_text("macro.friction", "macro.friction", "a * z", {{"a", 1.0}, {"b", 0.02, "shape"}});
    text.memories.push_back({.name = "z", .kind = kind, .of = of, .by = by});
    return text;
}

TEST(Formulas, AllSizesVanishing_AreNotThere) {
    FormulaEffect text =
        formula_text("macro.force", "macro.drive", "a + b * speed", {{"a", 1.0}, {"b", 1.0}});
    Formulas formulas;
    formulas.add(FormulaCode::of(text), std::array{0.0, 0.0});
    EXPECT_FALSE(formulas.any());
    formulas.add(FormulaCode::of(text), std::array{0.0, 2.0});
    EXPECT_TRUE(formulas.act(Port::force));
    EXPECT_FALSE(formulas.act(Port::friction));
    EXPECT_DOUBLE_EQ(formulas.value(Port::force, at_speed(3.0), {}), 6.0);
}

TEST(Formulas, Sum_IsOverThoseOfThePort) {
    Formulas formulas;
    formulas.add(FormulaCode::of(formula_text("macro.force", "macro.drive", "a", {{"a", 1.0}})),
                 std::array{1.5});
    formulas.add(FormulaCode::of(formula_text("macro.force", "macro.drive", "a * speed", {{"a", 1.0}})),
                 std::array{2.0});
    formulas.add(FormulaCode::of(formula_text("macro.friction", "macro.friction", "a * speed", {{"a", 1.0}})),
                 std::array{7.0});
    EXPECT_DOUBLE_EQ(formulas.value(Port::force, at_speed(3.0), {}), 7.5);
    EXPECT_DOUBLE_EQ(formulas.value(Port::friction, at_speed(3.0), {}), 21.0);
}

/// A rig file's formula with other values, as a diagnosis tries it.
TEST(Formulas, SameFormulaAgain_GetsTheNewValuesInItsPlace) {
    const FormulaEffect text = remembering(Kind::delay, "speed", "b");
    Formulas formulas = formulas_of(text);
    formulas.add(FormulaCode::of(text), std::array{3.0, 0.02});
    EXPECT_DOUBLE_EQ(formulas.value(Port::friction, at_speed(2.0), formulas.start(at_speed(2.0), tick_s)),
                     6.0);
    formulas.add(FormulaCode::of(text), std::array{0.0, 0.02});
    EXPECT_FALSE(formulas.any());
    EXPECT_FALSE(formulas.act(Port::friction));
    EXPECT_FALSE(formulas.remember());
}

TEST(Formulas, StateThatIsNoNumber_IsNamed) {
    const Formulas formulas = formulas_of(remembering(Kind::state, "sqrt(speed)"));
    FormulaMemory memory = formulas.start(at_speed(4.0), tick_s);
    try {
        formulas.begin_tick(memory, at_speed(-4.0), tick_s);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(),
                    testing::HasSubstr("of_test: state.z: comes to no number at speed = -4 with "));
        EXPECT_THAT(error.what(), testing::HasSubstr("; allowed: any finite number"));
    }
}

TEST(Formulas, NoNumberOrTooLarge_IsAnErrorThatSaysWhere) {
    const Formulas formulas =
        formulas_of(formula_text("macro.friction", "macro.friction", "a * sqrt(speed)", {{"a", 1.0}}));
    EXPECT_DOUBLE_EQ(formulas.value(Port::friction, at_speed(4.0), {}), 2.0);
    try {
        (void)formulas.value(Port::friction, at_speed(-4.0), {});
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("of_test: formula: gives"));
        EXPECT_THAT(error.what(),
                    testing::HasSubstr("at speed = -4 with a = 1; allowed: numbers up to 100 V"));
    }
    EXPECT_THROW((void)formulas.value(Port::friction, at_speed(1e6), {}), InputError);
}

TEST(Formulas, NoNumberOfAFormulaThatAFileStates_NamesFileLineAndKey) {
    Formulas formulas;
    formulas.add(
        FormulaCode::of(formula_text("macro.friction", "macro.friction", "a * sqrt(speed)", {{"a", 1.0}})),
        std::array{3.0}, "rig.yaml:36: effects[0]");
    try {
        (void)formulas.value(Port::friction, at_speed(-4.0), {});
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::StartsWith("rig.yaml:36: effects[0].formula: gives "));
        EXPECT_THAT(error.what(), testing::HasSubstr(" with a = 3; allowed: "));
    }
}

TEST(Formulas, DelayThatCannotBe_IsRefusedBeforeAnythingMoves) {
    const FormulaCode& code = FormulaCode::of(remembering(Kind::delay, "speed", "b"));
    Formulas formulas;
    EXPECT_NO_THROW(formulas.add(code, std::array{1.0, 10.0}));
    for (const double delay_s : {10.1, -0.001})
        EXPECT_THROW(formulas.add(code, std::array{1.0, delay_s}), FormulaFault) << delay_s;
}

TEST(Formulas, StateThatRelaxes_FollowsTheExponentialExactly) {
    const Formulas formulas = formulas_of(remembering(Kind::state, "(speed - z) / b"));
    FormulaMemory memory = formulas.start(at_speed(2.0), tick_s);
    EXPECT_NEAR(memory.values[0], 2.0, 1e-12) << "has stood for long";
    for (int k = 0; k < 50; ++k) {
        formulas.begin_tick(memory, at_speed(10.0), tick_s);
        EXPECT_NEAR(formulas.value(Port::friction, at_speed(10.0), memory),
                    10.0 - 8.0 * std::exp(-k * tick_s / 0.02), 1e-8)
            << k;
    }
}

TEST(Formulas, StateThatAddsUp_StartsAtZero) {
    const Formulas formulas = formulas_of(remembering(Kind::state, "speed"));
    FormulaMemory memory = formulas.start(at_speed(2.0), tick_s);
    EXPECT_EQ(memory.values[0], 0.0);
    for (int k = 0; k < 1000; ++k) formulas.begin_tick(memory, at_speed(3.0), tick_s);
    EXPECT_NEAR(memory.values[0], 3.0 * 0.999, 1e-9);
}

/// z' = c - z^2 from 0: z = sqrt(c) tanh(sqrt(c) t). It starts where that is at rest, so from c = 0.
TEST(Formulas, StateThatIsNotLinear_FollowsToFirstOrderOfTheTick) {
    const Formulas formulas = formulas_of(remembering(Kind::state, "speed - z ^ 2"));
    FormulaMemory memory;
    memory.tick_s = tick_s;
    for (int k = 0; k < 1000; ++k) formulas.begin_tick(memory, at_speed(4.0), tick_s);
    EXPECT_NEAR(memory.values[0], 2.0 * std::tanh(2.0 * 0.999), 1e-5);
}

TEST(Formulas, Play_FollowsOnceItsHalfWidthIsCrossed) {
    const Formulas formulas = formulas_of(remembering(Kind::play, "speed", "100 * b"));  // 2 mm/s wide
    FormulaMemory memory = formulas.start(at_speed(5.0), tick_s);
    const auto after = [&](double mm_per_s) {
        formulas.begin_tick(memory, at_speed(mm_per_s), tick_s);
        return memory.values[0];
    };
    EXPECT_DOUBLE_EQ(after(5.5), 5.0);
    EXPECT_DOUBLE_EQ(after(8.0), 7.0);
    EXPECT_DOUBLE_EQ(after(6.5), 7.0);
    EXPECT_DOUBLE_EQ(after(1.0), 2.0);
}

TEST(Formulas, Delay_IsWhatWasThenByStraightLines) {
    FormulaEffect text = remembering(Kind::delay, "speed", "b");
    for (const double delay_s : {0.0, 0.001, 0.0034, 0.02}) {
        text.parameters[1].typical = delay_s;
        const Formulas formulas = formulas_of(text);
        FormulaMemory memory = formulas.start(at_speed(0.0), tick_s);
        for (int k = 0; k < 100; ++k) {
            formulas.begin_tick(memory, at_speed(k), tick_s);
            EXPECT_NEAR(memory.values[0], std::max(0.0, k - delay_s / tick_s), 1e-9) << delay_s << ' ' << k;
        }
        // Looking at a time between ticks neither writes nor reads the past values.
        FormulaMemory between = memory;
        formulas.begin_tick(between, at_speed(1e3), 0.3 * tick_s);
        EXPECT_EQ(between.values[0], memory.values[0]);
    }
    for (const double delay_s : {-0.1, 10.5}) {
        text.parameters[1].typical = delay_s;
        EXPECT_THROW((void)formulas_of(text).start(at_speed(0.0), tick_s), InputError);
    }
}

TEST(Formulas, TwoEffects_RememberEachItsOwn) {
    Formulas formulas = formulas_of(remembering(Kind::delay, "speed", "b"));
    formulas.add(FormulaCode::of(remembering(Kind::state, "(2 * speed - z) / b")), std::array{1.0, 0.5});
    formulas.add(FormulaCode::of(remembering(Kind::delay, "3 * speed", "2 * b")), std::array{1.0, 0.02});
    FormulaMemory memory = formulas.start(at_speed(1.0), tick_s);
    EXPECT_NEAR(formulas.value(Port::friction, at_speed(1.0), memory), 1.0 + 2.0 + 3.0, 1e-9);
    for (int k = 0; k < 30; ++k) formulas.begin_tick(memory, at_speed(5.0), tick_s);
    EXPECT_NEAR(memory.values[0], 5.0, 1e-12) << "20 ms late";
    EXPECT_NEAR(memory.values[1], 10.0 - 8.0 * std::exp(-0.029 / 0.5), 1e-8);
    EXPECT_NEAR(memory.values[2], 3.0, 1e-12) << "40 ms late";
}

}  // namespace
}  // namespace fidservo::plant
