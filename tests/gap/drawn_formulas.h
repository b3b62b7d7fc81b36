// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Random formulas at random ports of the machine.
#include "core/formula_effect.h"
#include "core/random.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace fidservo::testing {

/// A variable of a formula with its usual range, and how it is written.
struct Ingredient {
    const char* name;
    double middle, reach;
};

/// A port with the variables of its formulas, and their order of magnitude.
struct Place {
    const char* port;
    const char* block;
    double size;
    std::vector<Ingredient> ingredients;
};

inline const std::vector<Place>& places() {
    static const Ingredient speed{"speed", 0.0, 100.0}, place{"place", 100.0, 40.0},
        command{"command", 0.0, 4.0}, wire{"wire_temp", 60.0, 25.0}, power{"heater_power", 80.0, 60.0},
        contraction{"contraction", 2.0, 1.5}, platform{"platform", 2.0, 1.5};
    static const std::vector<Place> all{
        {"macro.force", "macro.mechanics", 0.1, {place}},
        {"macro.friction", "macro.friction", 0.1, {speed, place}},
        {"macro.drive_voltage", "macro.drive", 0.1, {command, place}},
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

inline double even(NoiseStream& stream, double low, double high) {
    return low + (high - low) * stream.uniform();
}

inline std::size_t pick(NoiseStream& stream, std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(stream.uniform() * static_cast<double>(count)));
}

/// A factor with one variable, of order 1; and the name of its shape parameter, if it has one.
struct Factor {
    std::string text;
    bool has_shape;
    double low, high, value;
};

inline Factor factor_of(const Ingredient& of, const std::string& shape, NoiseStream& stream) {
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
    std::vector<Ingredient> ingredients;  ///< the variables on which it depends
};

/// A formula with one or two factors; its size differs from the typical one.
inline Drawn draw(std::uint64_t seed) {
    NoiseStream stream(seed, "formulas");
    const Place& at = places()[pick(stream, places().size())];
    Drawn drawn;
    drawn.text.name = fmt::format("own_{}", seed);
    drawn.text.acts_on = at.port;
    drawn.text.block = at.block;
    drawn.text.text = "drawn at random";
    drawn.text.parameters.push_back(
        {.name = "size", .low = -20.0 * at.size, .high = 20.0 * at.size, .typical = at.size, .role = "size"});
    // Friction with a negative sign would make the carriage run away.
    const bool may_be_negative = std::string(at.port) != "macro.friction";
    drawn.truth.push_back((may_be_negative && stream.uniform() < 0.5 ? -1.0 : 1.0) * at.size *
                          std::exp(even(stream, -0.7, 1.1)));
    std::string formula = "size";
    const std::size_t factors = 1 + pick(stream, std::min<std::size_t>(2, at.ingredients.size()));
    for (std::size_t k = 0; k < factors; ++k) {
        const std::string shape = fmt::format("shape_{}", k);
        const Factor factor = factor_of(at.ingredients[k], shape, stream);
        drawn.ingredients.push_back(at.ingredients[k]);
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

}  // namespace fidservo::testing
