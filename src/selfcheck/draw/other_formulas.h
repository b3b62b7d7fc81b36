// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Effects of the catalogue made by a formula that the catalogue does not have for them.
#include "src/selfcheck/draw/listed_effects.h"

#include <span>
#include <string_view>
#include <vector>

namespace fidservo::selfcheck {

/// Floor sizes are only where a search for a size begins.
std::span<const EffectDraw> other_formulas();

/// Those of a class; empty where there is none.
std::vector<const EffectDraw*> other_formulas_of(std::string_view class_name);

}  // namespace fidservo::selfcheck
