// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Formula effects as effects: known by name, tried, fitted and stated like those that are listed.
#include "core/formula_effect.h"
#include "plant/effects/effect.h"

#include <span>

namespace fidservo::plant {

/// The effect of a text: the same one for the same text, there until the program ends. May be called from
/// several threads. Throws InputError "NAME: KEY: what is wrong; what is allowed": an unknown port, a block
/// that is not the port's, names that are not known there, values out of order, a name that a listed effect
/// has.
const Effect& effect_of(const FormulaEffect& text);

/// Puts a formula into a plant's parameters.
void add_formula(const FormulaCode& code, PlantParameters& plant, std::span<const double> values);

}  // namespace fidservo::plant
