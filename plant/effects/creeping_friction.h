// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Dry friction that lets the carriage creep instead of holding it at rest: a parameter that several effects
// share.
#include "plant/effects/effect.h"

#include <algorithm>

namespace fidservo::plant::effects {

/// The creep speed. Values below 0.03 mm/s, half a count a second, count as 0: so slow a creep makes the
/// equations stiff, and its motion is too small to be seen.
inline constexpr EffectParameter creep_speed = parameter::optional(
    {"creep_mm_per_s", "mm/s", 0.0, 5.0, 0.0, 0.0,
     "below which it lets the carriage creep; less than 0.03, half a count a second: it holds it at rest"},
    0.03);

/// Sets the contact's creep speed. There is one contact only: of several effects the one with the fastest
/// creep decides.
inline void let_creep(Friction& friction, double creep_mm_per_s) {
    friction.creep_mm_per_s = std::max(friction.creep_mm_per_s, creep_speed.acting(creep_mm_per_s));
}

}  // namespace fidservo::plant::effects
