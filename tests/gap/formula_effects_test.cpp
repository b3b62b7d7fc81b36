// Formulas of an effects file are found by name, beside the listed effects.
#include "core/random.h"
#include "gap/diagnose.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

namespace fidservo::gap {
namespace {

using testing::recordings_of;

/// What a formula may depend on, over about what it varies, and how it is written.
struct Ingredient {
    const char* name;
    double middle, reach;
};

/// A port with what its formulas are made of, and about how large they are.
struct Place {
    const char* port;
    const char* block;
    double size;
    std::vector<Ingredient> ingredients;
};

const std::vector<Place>& places() {
    static const Ingredient speed{"speed", 0.0, 100.0}, place{"place", 100.0, 40.0},
        command{"command", 0.0, 4.0}, wire{"wire_temp", 60.0, 25.0}, power{"heater_power", 80.0, 60.0},
        contraction{"contraction", 2.0, 1.5}, platform{"platform", 2.0, 1.5};
    static const std::vector<Place> all{
        {"macro.force", "macro.mechanics", 0.1, {place, speed}},
        {"macro.friction", "macro.friction", 0.1, {speed, place}},
        {"macro.drive_voltage", "macro.drive", 0.1, {command, speed}},
        {"macro.encoder", "macro.encoder", 0.1, {place}},
        {"micro.heater_power", "micro.heater", 5.0, {power, wire}},
        {"micro.heat_flow", "micro.heater", 5.0, {wire, contraction}},
        {"micro.transformation", "micro.hysteresis", 3.0, {contraction, wire}},
        {"micro.contraction", "micro.hysteresis", 0.05, {contraction, wire}},
        {"micro.hall_voltage", "micro.hall", 0.03, {platform}},
        {"camera.rotation", "camera.geometry", 0.01, {{"camera_place", 100.0, 40.0}}},
        {"plate.tag_x", "plate", 0.02, {{"tag_x", 100.0, 40.0}}},
    };
    return all;
}

double even(NoiseStream& stream, double low, double high) {
    return low + (high - low) * stream.uniform();
}

std::size_t pick(NoiseStream& stream, std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(stream.uniform() * static_cast<double>(count)));
}

/// A factor of one ingredient, of order 1; a shape parameter's name where it has one.
struct Factor {
    std::string text;
    bool has_shape;
    double low, high, value;
};

Factor factor_of(const Ingredient& of, const std::string& shape, NoiseStream& stream) {
    const std::string x = fmt::format("(({} - {}) / {})", of.name, of.middle, of.reach);
    switch (pick(stream, 6)) {
        case 0:
            return {x, false, 0, 0, 0};
        case 1:
            return {fmt::format("{0} * abs({0})", x), false, 0, 0, 0};
        case 2:
            return {fmt::format("{}^3", x), false, 0, 0, 0};
        case 3:
            return {fmt::format("sin({} * {})", shape, x), true, 0.5, 8.0, even(stream, 1.0, 6.0)};
        case 4:
            return {fmt::format("tanh({} * {})", shape, x), true, 0.3, 10.0, even(stream, 1.0, 5.0)};
        default:
            return {fmt::format("exp(-({} * {})^2)", shape, x), true, 0.3, 8.0, even(stream, 0.8, 3.0)};
    }
}

struct Drawn {
    FormulaEffect text;
    std::vector<double> truth;
};

/// A formula of one factor or two; its size is not the typical one.
Drawn draw(std::uint64_t seed) {
    NoiseStream stream(seed, "formulas");
    const Place& at = places()[pick(stream, places().size())];
    Drawn drawn;
    drawn.text.name = fmt::format("own_{}", seed);
    drawn.text.acts_on = at.port;
    drawn.text.block = at.block;
    drawn.text.text = "drawn at random";
    drawn.text.parameters.push_back(
        {.name = "size", .low = -20.0 * at.size, .high = 20.0 * at.size, .typical = at.size, .role = "size"});
    drawn.truth.push_back((stream.uniform() < 0.5 ? -1.0 : 1.0) * at.size *
                          std::exp(even(stream, -0.7, 1.1)));
    std::string formula = "size";
    const std::size_t factors = 1 + pick(stream, std::min<std::size_t>(2, at.ingredients.size()));
    for (std::size_t k = 0; k < factors; ++k) {
        const std::string shape = fmt::format("shape_{}", k);
        const Factor factor = factor_of(at.ingredients[k], shape, stream);
        formula += " * " + factor.text;
        if (!factor.has_shape) continue;
        drawn.text.parameters.push_back({.name = shape,
                                         .low = factor.low,
                                         .high = factor.high,
                                         .vanishing = factor.low,
                                         .typical = std::sqrt(factor.low * factor.high),
                                         .role = "shape"});
        drawn.truth.push_back(factor.value);
    }
    drawn.text.formula = formula;
    return drawn;
}

/// What is found of a drawn formula; its gap.
struct Outcome {
    double floors = 0.0, left = 0.0;
    bool is_named = false, is_alone = false;
    std::string names;
};

Outcome diagnosed(const Drawn& drawn) {
    const plant::Effect& effect = plant::effect_of(drawn.text);
    const Evidence evidence(reference_rig(), recordings_of({{&effect, drawn.truth}},
                                                           {"macro-pulses", "macro-square", "macro-sweep",
                                                            "micro-steps", "micro-triangle", "integrated"}));
    DiagnosisOptions options;
    options.formulas = {&effect};
    const Diagnosis diagnosis = diagnose(evidence, options);
    Outcome outcome{diagnosis.gap.before, diagnosis.gap.after, false, diagnosis.effects.size() == 1, {}};
    for (const FoundEffect& found : diagnosis.effects) {
        outcome.is_named = outcome.is_named || found.effect == drawn.text.name;
        outcome.names += " " + found.effect;
    }
    return outcome;
}

/// FIDSERVO_FORMULAS sets how many are drawn.
TEST(SlowFormulaEffects, DrawnAtRandomPorts_AreFoundByName) {
    const char* const asked = std::getenv("FIDSERVO_FORMULAS");
    const int tried = asked != nullptr ? std::atoi(asked) : 8;
    int shown = 0, named = 0, alone = 0;
    for (int k = 0; k < tried; ++k) {
        const Drawn drawn = draw(static_cast<std::uint64_t>(9100 + k));
        const Outcome outcome = diagnosed(drawn);
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

}  // namespace
}  // namespace fidservo::gap
