// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An effect that is in no catalogue, as a rig may have it.
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"
#include "tests/plant/formulas/texts.h"

#include <string>

namespace fidservo::testing {

/// @param formula  with `size` for its only parameter
inline plant::EffectSetting hidden_formula(const std::string& acts_on, const std::string& block,
                                           const std::string& formula, double size) {
    return plant::typical_setting(
        plant::effect_of(plant::formula_text(acts_on, block, formula, {{"size", size}})));
}

}  // namespace fidservo::testing
