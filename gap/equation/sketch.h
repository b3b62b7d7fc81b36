// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A draft of a formula: terms of a port with values of their coefficients.
#include "core/formula_effect.h"
#include "gap/equation/terms.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::gap {

/// Terms of a port in the order in which they were selected, with start values of their coefficients: one for
/// each of Term::texts, one term after the other.
struct Sketch {
    plant::Port port = plant::Port::force;
    std::vector<Term> terms;
    std::vector<double> coefficients;

    std::size_t shapes() const;
};

/// The largest numbers of coefficients and shapes in an equation.
inline constexpr std::size_t most_coefficients = 4, most_equation_shapes = 2;

/// The sketch as a formula effect, with coefficients a, b, c, d, shapes p, q and memories m, n. It is
/// assigned to the block if the port allows that.
FormulaEffect formula_of(const Sketch& sketch, std::string_view block, const std::string& name);

/// A sketch of a single expression of a term.
Sketch one_text_of(plant::Port port, const Term& term, std::size_t text, double coefficient);
/// The sketch with other values.
/// @param values  of all coefficients and shapes, in the order of formula_of's parameters
Sketch with_values(Sketch sketch, std::span<const double> values);
/// The sketch with its first term only.
Sketch first_of(const Sketch& sketch);
/// The sketch without one of its terms.
Sketch without(const Sketch& sketch, std::size_t term);
/// A sketch with the terms of both; empty where those are too many for an equation, or a term is in both.
std::optional<Sketch> joined(Sketch sketch, const Sketch& more);

}  // namespace fidservo::gap
