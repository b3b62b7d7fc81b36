// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an effect adds at a port of the machine, as the formula that a diagnosis might propose for it.
#include "core/formula_effect.h"
#include "src/selfcheck/draw/true_rig.h"

#include <optional>
#include <string_view>

namespace fidservo {
struct Rig;
}

namespace fidservo::selfcheck {

/// The formula, numbers and all, of a rig with one effect, where one formula at one port states it; empty
/// otherwise (why_not_a_formula).
/// @param nominal  the rig as its file describes it
/// @param effect  a name of the catalogue, or of an effect that it lacks
std::optional<FormulaEffect> as_formula(const TrueRig& rig, const Rig& nominal, std::string_view effect);

/// Why an effect is none that a formula at a port states, in words; empty for one that is, or that nobody
/// knows.
std::string_view why_not_a_formula(std::string_view effect);

}  // namespace fidservo::selfcheck
