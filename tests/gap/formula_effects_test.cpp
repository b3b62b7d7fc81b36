// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas of an effects file are found by name, beside the listed effects.
#include "core/input_error.h"
#include "gap/diagnose.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"
#include "src/diagnose/time_limit.h"
#include "tests/effort.h"
#include "tests/gap/drawn_formulas.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

namespace fidservo::gap {
namespace {

using testing::draw;
using testing::Drawn;
using testing::recordings_of;

/// What is found of a drawn formula; its gap.
struct Outcome {
    double floors = 0.0, left = 0.0;
    bool is_named = false, is_alone = false;
    std::string names;
};

/// Throws InputError where the drawn one is none that a machine can have.
Evidence evidence_of(const Drawn& drawn, std::shared_ptr<const Budget> budget = {}) {
    return {reference_rig(),
            recordings_of({{&plant::effect_of(drawn.text), drawn.truth}},
                          {"macro-pulses", "macro-square", "macro-sweep", "micro-steps", "micro-triangle",
                           "integrated"}),
            std::move(budget)};
}

int drawn_count(int usual) {
    const char* const asked = std::getenv("FIDSERVO_FORMULAS");
    return asked != nullptr ? std::atoi(asked) : usual;
}

Outcome diagnosed(const Drawn& drawn, const Evidence& evidence) {
    const plant::Effect& effect = plant::effect_of(drawn.text);
    DiagnosisOptions options;
    options.formulas = {&effect};
    const Diagnosis diagnosis = gap::diagnose(evidence, options);
    Outcome outcome{diagnosis.gap.before, diagnosis.gap.after, false, diagnosis.effects.size() == 1, {}};
    for (const FoundEffect& found : diagnosis.effects) {
        outcome.is_named = outcome.is_named || found.effect == drawn.text.name;
        outcome.names += " " + found.effect;
    }
    return outcome;
}

/// The next drawn one that a machine can have, from a number on.
std::pair<Drawn, Evidence> next_drawn(std::uint64_t& number,
                                      const std::function<std::shared_ptr<const Budget>()>& budget = {}) {
    for (;;) {
        Drawn drawn = draw(number++);
        try {
            Evidence evidence = evidence_of(drawn, budget ? budget() : nullptr);
            return {std::move(drawn), std::move(evidence)};
        } catch (const InputError&) {
            continue;
        }
    }
}

/// FIDSERVO_FORMULAS sets how many are drawn.
TEST(SlowFormulaEffects, DrawnAtRandomPorts_AreFoundByName) {
    const int tried = drawn_count(fidservo::testing::draws(9, 2));
    int shown = 0, named = 0, alone = 0;
    std::uint64_t number = 9100;
    for (int k = 0; k < tried; ++k) {
        const auto [drawn, evidence] = next_drawn(number);
        const Outcome outcome = diagnosed(drawn, evidence);
        fmt::print("{} {}: {} = {}; {:.3g} floors, {:.3g} left; named:{}\n", k, drawn.text.acts_on,
                   drawn.text.formula, fmt::join(drawn.truth, ", "), outcome.floors, outcome.left,
                   outcome.names);
        std::fflush(stdout);
        constexpr double floors_that_show = 3.0;
        if (outcome.floors < floors_that_show) continue;
        ++shown;
        named += outcome.is_named ? 1 : 0;
        alone += outcome.is_named && outcome.is_alone ? 1 : 0;
    }
    fmt::print("formulas | tried {} | of 3 floors or more {} | named {} | alone {}\n", tried, shown, named,
               alone);
    ASSERT_GE(shown, tried / 2);
    EXPECT_GE(named, (9 * shown) / 10);
}

/// R.m.s. of a proposed formula minus the true one over what the true one depends on, over the r.m.s. of
/// that. Of the encoder without means: recordings do not tell by how much all places are beside.
double apart(const Drawn& drawn, const Equation& equation) {
    const plant::FormulaCode& truth = plant::FormulaCode::of(drawn.text);
    const plant::FormulaCode& found = *equation.setting.effect->formula;
    if (found.port().port != truth.port().port) return 1.0;
    const auto known = plant::variables_of(truth.port().site);
    NoiseStream stream(1, "places");
    std::vector<double> right, proposed;
    for (int k = 0; k < 4000; ++k) {
        std::vector<double> variables(known.size(), 0.0);
        for (const testing::Ingredient& of : drawn.ingredients)
            for (std::size_t v = 0; v < known.size(); ++v)
                if (known[v].name == of.name)
                    variables[v] = of.middle + of.reach * testing::even(stream, -1.0, 1.0);
        if (truth.port().site == plant::Site::carriage) {
            double& speed = variables[plant::carriage_variable::speed];
            if (speed == 0.0) speed = 50.0;
            variables[plant::carriage_variable::direction] = speed < 0.0 ? -1.0 : 1.0;
        }
        right.push_back(truth.value(variables, {}, drawn.truth));
        proposed.push_back(found.value(variables, {}, equation.setting.values));
    }
    if (truth.port().site == plant::Site::encoder)
        for (std::vector<double>* values : {&right, &proposed}) {
            const double mean =
                std::accumulate(values->begin(), values->end(), 0.0) / static_cast<double>(values->size());
            for (double& value : *values) value -= mean;
        }
    double different = 0.0, all = 0.0;
    for (std::size_t k = 0; k < right.size(); ++k) {
        different += (proposed[k] - right[k]) * (proposed[k] - right[k]);
        all += right[k] * right[k];
    }
    return std::sqrt(different / all);
}

/// What no effect explains is proposed as an equation, by its own library of terms. A search that cannot come
/// to an end is ended as the command ends it.
TEST(SlowEquations, OfDrawnFormulas_AreProposedAndRemoveTheGap) {
    const int tried = drawn_count(fidservo::testing::draws(9, 0));
    if (tried == 0) GTEST_SKIP() << "SlowEquation proposes two: one of all draws (./run test --all-draws)";
    int shown = 0, proposed = 0, right_variables = 0, right_form = 0;
    std::vector<double> removed;
    std::uint64_t number = 9900;
    const auto half_a_minute = [] {
        return std::make_shared<const Budget>(fidservo::diagnose::half_a_minute.search_s,
                                              fidservo::diagnose::half_a_minute.whole_s,
                                              std::function<bool()>{});
    };
    for (int k = 0; k < tried; ++k) {
        const auto [drawn, evidence] = next_drawn(number, half_a_minute);
        DiagnosisOptions options;
        options.equation_s = fidservo::diagnose::half_a_minute.equation_s;
        const Diagnosis diagnosis = gap::diagnose(evidence, options);
        fmt::print("{} {}: {} = {}; {:.3g} floors, {:.3g} left\n", k, drawn.text.acts_on, drawn.text.formula,
                   fmt::join(drawn.truth, ", "), diagnosis.gap.before, diagnosis.gap.after);
        for (const FoundEffect& found : diagnosis.effects)
            fmt::print("    {} {:.2f}\n", found.effect, found.probability);
        constexpr double floors_of_a_gap = 10.0;
        const bool is_left = diagnosis.verdict != Verdict::explained && diagnosis.verdict != Verdict::no_gap;
        if (diagnosis.gap.before < floors_of_a_gap || !is_left) continue;
        ++shown;
        if (!diagnosis.unexplained || !diagnosis.unexplained->equation) continue;
        const Equation& equation = *diagnosis.unexplained->equation;
        ++proposed;
        std::vector<std::string> true_variables;
        for (const testing::Ingredient& of : drawn.ingredients) true_variables.emplace_back(of.name);
        std::vector<std::string> variables = equation.variables;
        std::erase(variables, "direction");
        std::ranges::sort(variables);
        std::ranges::sort(true_variables);
        const double off = apart(drawn, equation);
        right_variables += variables == true_variables ? 1 : 0;
        right_form += off < 0.05 ? 1 : 0;
        removed.push_back(equation.gap_removed);
        fmt::print("    {} at {}: {:.3g} apart, {:.3g} removed\n", equation.formula, equation.acts_on, off,
                   equation.gap_removed);
        std::fflush(stdout);
    }
    std::ranges::sort(removed);
    fmt::print(
        "equations | tried {} | something left {} | proposed {} | right variables {} | within 5 % {} | "
        "removed, median {:.3g}\n",
        tried, shown, proposed, right_variables, right_form,
        removed.empty() ? 0.0 : removed[removed.size() / 2]);
    EXPECT_GE(2 * proposed, shown);
}

}  // namespace
}  // namespace fidservo::gap
