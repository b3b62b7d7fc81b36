// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The true contribution of an effect at a port of the simulated machine, as a formula with which the equation
// that a diagnosis proposes is compared.
#include "core/formula_effect.h"
#include "src/selfcheck/draw/true_rig.h"

#include <optional>
#include <string_view>

namespace fidservo {
struct Rig;
}

namespace fidservo::selfcheck {

/// The formula, with its coefficients, of the only effect of a rig; empty if a single formula at a single
/// port cannot state the effect (why_not_a_formula()).
/// @param nominal  the rig as its file describes it
/// @param effect  a name of the catalogue, or of an effect that it lacks
std::optional<FormulaEffect> as_formula(const TrueRig& rig, const Rig& nominal, std::string_view effect);

/// Why an effect cannot be stated as a formula at a port, in words; empty for one that can, and for unknown
/// names.
std::string_view why_not_a_formula(std::string_view effect);

}  // namespace fidservo::selfcheck
