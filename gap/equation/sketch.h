// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A formula on its way: terms of a port with values of their coefficients.
#include "core/formula_effect.h"
#include "gap/equation/terms.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::gap {

/// Terms of a port in the order in which they were taken in, with first values of their coefficients: one for
/// each of Term::texts, one term after the other.
struct Sketch {
    plant::Port port = plant::Port::force;
    std::vector<Term> terms;
    std::vector<double> coefficients;

    std::size_t shapes() const;
};

/// The most that an equation has.
inline constexpr std::size_t most_coefficients = 4, most_equation_shapes = 2;

/// As a formula effect: coefficients a, b, c, d; shapes p, q; what it remembers m, n. It is of the block
/// where the port allows that.
FormulaEffect formula_of(const Sketch& sketch, std::string_view block, const std::string& name);

/// One of a term's expressions alone.
Sketch one_text_of(plant::Port port, const Term& term, std::size_t text, double coefficient);
/// @param values  of all coefficients and shapes, in the order of formula_of's parameters
Sketch with_values(Sketch sketch, std::span<const double> values);
/// The first term alone.
Sketch first_of(const Sketch& sketch);
/// All terms but one.
Sketch without(const Sketch& sketch, std::size_t term);
/// Both; none where that is more than an equation has, or has a term twice.
std::optional<Sketch> joined(Sketch sketch, const Sketch& more);

}  // namespace fidservo::gap
