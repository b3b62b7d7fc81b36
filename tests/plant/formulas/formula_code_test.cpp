// SPDX-License-Identifier: GPL-3.0-or-later
// What a formula may contain, and the messages on others.
#include "plant/formulas/formula_code.h"

#include "core/input_error.h"
#include "plant/formulas/formula_effect.h"
#include "tests/plant/formulas/texts.h"

#include <array>
#include <clocale>
#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

using testing::HasSubstr;

FormulaEffect friction(const std::string& formula) {
    return formula_text("macro.friction", "macro.friction", formula, {{"a", 2.0}, {"b", 3.0, "shape"}});
}

/// At a speed of 5 mm/s, 40 mm from the left end.
double value_of(const std::string& formula) {
    std::array<double, carriage_variable::count> at{};
    at[carriage_variable::place] = 40.0;
    at[carriage_variable::speed] = 5.0;
    at[carriage_variable::direction] = 1.0;
    return FormulaCode::of(friction(formula)).value(at, {}, std::array{2.0, 3.0});
}

std::string refusal_of(const FormulaEffect& text) {
    try {
        (void)effect_of(text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(FormulaCode, Expressions_HaveTheirUsualMeaning) {
    EXPECT_DOUBLE_EQ(value_of("a + b * speed"), 17.0);
    EXPECT_DOUBLE_EQ(value_of("-b^2"), -9.0) << "a power binds tighter than a sign";
    EXPECT_DOUBLE_EQ(value_of("(-b)^2"), 9.0);
    EXPECT_DOUBLE_EQ(value_of("2^b^2"), 512.0);
    EXPECT_DOUBLE_EQ(value_of("a * sin(2 * pi * place / 160)"), 2.0);
    EXPECT_DOUBLE_EQ(value_of("speed > 4 && place <= 40 ? a : b"), 2.0);
    EXPECT_DOUBLE_EQ(value_of("if(speed == 5, a, b) + sign(-speed) + abs(-b)"), 4.0);
    EXPECT_DOUBLE_EQ(value_of("min(a, b) + 10 * max(a, b)"), 32.0);
    EXPECT_DOUBLE_EQ(value_of("tanh(speed) + exp(-b) + log(a) + sqrt(place) + cos(b) + tan(a) + atan2(a, b)"),
                     std::tanh(5.0) + std::exp(-3.0) + std::log(2.0) + std::sqrt(40.0) + std::cos(3.0) +
                         std::tan(2.0) + std::atan2(2.0, 3.0));
    EXPECT_DOUBLE_EQ(value_of("1.5e1"), 15.0);
}

TEST(FormulaCode, NotANumber_IsNotHiddenByMinOrMax) {
    EXPECT_TRUE(std::isnan(value_of("min(sqrt(-a), b)")));
    EXPECT_TRUE(std::isnan(value_of("max(b, log(-a))")));
}

TEST(FormulaCode, WhatIsNoValue_IsRefusedWithItsPlaceAndWhatIsAllowed) {
    EXPECT_THAT(
        refusal_of(friction("a * velocity")),
        testing::AllOf(HasSubstr("of_test: formula"), HasSubstr("character 5"), HasSubstr("\"velocity\""),
                       HasSubstr("allowed: time, command, voltage, place, speed")));
    EXPECT_THAT(refusal_of(friction("a = 3")), HasSubstr("character 3"));
    EXPECT_THAT(refusal_of(friction("a == b ? \"x\" : b")), HasSubstr("neither assignments nor strings"));
    EXPECT_THAT(refusal_of(friction("a * (speed")), HasSubstr("allowed: numbers"));
    EXPECT_THAT(refusal_of(friction("a, b")), HasSubstr("more than one value"));
    EXPECT_THAT(refusal_of(friction("a * 0,5")), HasSubstr("with . in numbers"));
    EXPECT_THAT(refusal_of(friction("")), HasSubstr("is empty"));
    EXPECT_THAT(refusal_of(friction("a * rnd(b)")), HasSubstr("of_test: formula: character"));
    EXPECT_THAT(refusal_of(friction("a +")), HasSubstr("of_test: formula"));
}

TEST(FormulaCode, TextsThatDoNotFitTheMachine_AreRefused) {
    FormulaEffect text = friction("a * speed");
    text.acts_on = "macro.brake";
    EXPECT_THAT(refusal_of(text), HasSubstr("allowed: macro.drive_voltage, macro.force, macro.friction"));
    text = friction("a * speed");
    text.block = "micro.hall";
    EXPECT_THAT(refusal_of(text), HasSubstr("allowed: macro.friction, macro.mechanics"));
    text = friction("a * speed");
    text.name = "cogging";
    EXPECT_THAT(refusal_of(text), HasSubstr("listed effect"));
    text = friction("a * speed");
    text.parameters[0].name = "speed";
    EXPECT_THAT(refusal_of(text), HasSubstr("means something else"));
    text = friction("a * speed");
    text.parameters[1].name = "2nd";
    EXPECT_THAT(refusal_of(text), HasSubstr("is no name"));
    text = friction("a * speed");
    text.parameters[0].high = -1e5;
    EXPECT_THAT(refusal_of(text), HasSubstr("parameters.a.bounds"));
    text = friction("a * speed");
    text.parameters[0].typical = 2e5;
    EXPECT_THAT(refusal_of(text), HasSubstr("allowed: -10000 .. 10000"));
    text = friction("a * speed");
    text.parameters[0].typical = 0.0;
    EXPECT_THAT(refusal_of(text), HasSubstr("with which the effect is there"));
    text = friction("a * speed");
    text.parameters[0].role = "shape";
    EXPECT_THAT(refusal_of(text), HasSubstr("none has the role size"));
    text = formula_text("macro.encoder", "macro.encoder", "a * y", {{"a", 1.0}});
    text.memories.push_back({.name = "y", .of = "place - y"});
    EXPECT_THAT(refusal_of(text), HasSubstr("nothing is remembered at macro.encoder"));
    text = friction("a * late");
    text.memories.push_back(
        {.name = "late", .kind = FormulaEffect::Memory::Kind::delay, .of = "speed", .by = "time"});
    EXPECT_THAT(refusal_of(text), HasSubstr("delay.late.by"));
}

TEST(FormulaCode, LocaleWithDecimalComma_ChangesNothing) {
    const std::string before = std::setlocale(LC_ALL, nullptr);
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"})
        if (std::setlocale(LC_ALL, name) != nullptr) break;
    EXPECT_DOUBLE_EQ(value_of("1.25 * a"), 2.5);
    std::setlocale(LC_ALL, before.c_str());
}

TEST(FormulaCode, SameText_IsTheSameEffect) {
    EXPECT_EQ(&effect_of(friction("a + speed")), &effect_of(friction("a + speed")));
    EXPECT_NE(&effect_of(friction("a + speed")), &effect_of(friction("a - speed")));
}

TEST(FormulaCode, EveryThread_HasItsOwnParser) {
    const FormulaCode& code = FormulaCode::of(friction("a * speed + b * place"));
    std::vector<int> wrong(4, 0);
    {
        std::vector<std::jthread> threads;
        for (std::size_t t = 0; t < wrong.size(); ++t)
            threads.emplace_back([&code, &wrong, t] {
                std::array<double, carriage_variable::count> at{};
                for (int k = 0; k < 20000; ++k) {
                    at[carriage_variable::speed] = static_cast<double>(t) + 1.0;
                    at[carriage_variable::place] = k;
                    if (code.value(at, {}, std::array{10.0, 1.0}) !=
                        10.0 * (static_cast<double>(t) + 1.0) + k)
                        ++wrong[t];
                }
            });
    }
    EXPECT_THAT(wrong, testing::Each(0));
}

TEST(FormulaCode, EveryVariableOfEveryPort_IsKnownThere) {
    for (const PortDescription& port : ports()) {
        EXPECT_EQ(find_port(port.name), &port);
        EXPECT_FALSE(port.meaning.empty());
        std::string formula = "a";
        for (const std::size_t variable : port.variables)
            formula += " + " + std::string(variables_of(port.site)[variable].name);
        const FormulaCode& code = FormulaCode::of(
            formula_text(std::string(port.name), std::string(port.blocks.front()), formula, {{"a", 1.0}}));
        for (const std::size_t variable : port.variables) EXPECT_TRUE(code.uses(variable)) << port.name;
    }
}

}  // namespace
}  // namespace fidservo::plant
