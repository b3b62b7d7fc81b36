// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Effects of the catalogue simulated by another formula than the catalogue's.
#include "src/selfcheck/draw/listed_effects.h"

#include <span>
#include <string_view>
#include <vector>

namespace fidservo::selfcheck {

/// EffectDraw::floor_size of these is only a start value of the search for a size (draw/gap_alone.h).
std::span<const EffectDraw> other_formulas();

/// The other formulas of a class; empty if there are none.
std::vector<const EffectDraw*> other_formulas_of(std::string_view class_name);

}  // namespace fidservo::selfcheck
