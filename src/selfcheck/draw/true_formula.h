// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An effect's contribution at a port of the machine, as the formula that a diagnosis might propose.
#include "core/formula_effect.h"
#include "src/selfcheck/draw/true_rig.h"

#include <optional>
#include <string_view>

namespace fidservo {
struct Rig;
}

namespace fidservo::selfcheck {

/// The formula with its numbers for a rig with one effect, where one formula at one port states it; empty
/// otherwise (why_not_a_formula).
/// @param nominal  the rig as its file describes it
/// @param effect  a name of the catalogue, or of an effect that it lacks
std::optional<FormulaEffect> as_formula(const TrueRig& rig, const Rig& nominal, std::string_view effect);

/// Why an effect cannot be stated as a formula at a port, in words; empty for one that can, and for unknown
/// names.
std::string_view why_not_a_formula(std::string_view effect);

}  // namespace fidservo::selfcheck
