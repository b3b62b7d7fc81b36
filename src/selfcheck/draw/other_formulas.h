// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Effects of the catalogue simulated by another formula than the catalogue's.
#include "src/selfcheck/draw/listed_effects.h"

#include <span>
#include <string_view>
#include <vector>

namespace fidservo::selfcheck {

/// Their floor sizes only serve as start of the search for a size.
std::span<const EffectDraw> other_formulas();

/// Those of a class; empty where there is none.
std::vector<const EffectDraw*> other_formulas_of(std::string_view class_name);

}  // namespace fidservo::selfcheck
