// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Formulas as effects: found by name, tried, fitted and stated like those of the catalogue.
#include "core/formula_effect.h"
#include "plant/effects/effect.h"

#include <span>
#include <string>

namespace fidservo {
struct StatedEffect;
}

namespace fidservo::plant {

/// The effect of a formula's text: for the same text the same effect, which lives until the program ends. May
/// be called from several threads. Throws InputError "NAME: KEY: what is wrong; what is allowed": an unknown
/// port, a block that is not the port's, unknown names in expressions, values out of order, or the name of an
/// effect of the catalogue.
const Effect& effect_of(const FormulaEffect& text);

/// A formula that a rig file states, as an effect whose parameters take the place of the stated ones: it is
/// absent where they are the stated ones, and each of them is a size of the change, by a fifth of its own
/// size where that is typical. Otherwise like effect_of().
/// @param stated  has a formula
const Effect& refit_of(const StatedEffect& stated);

/// Puts a formula into a plant's parameters. Where the plant has it already, with the values of before, these
/// are replaced.
/// @param stated_at  as in StatedEffect
void add_formula(const FormulaCode& code, PlantParameters& plant, std::span<const double> values,
                 const std::string& stated_at);

}  // namespace fidservo::plant
