// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Puts an effect of the catalogue with a log-uniform random size into a rig.
#include "core/random.h"
#include "src/selfcheck/draw/label.h"
#include "src/selfcheck/draw/listed_effects.h"
#include "src/selfcheck/draw/true_rig.h"

#include <string_view>

namespace fidservo::selfcheck {

/// The label of an effect that was simulated in a given way.
TrueEffect true_effect(const EffectDraw& way, double size);

/// One of the ways to make an effect of a class, from below the floor, or a 300th of the largest where that
/// is more, to the largest.
TrueEffect put_listed(TrueRig& rig, std::string_view class_name, NoiseStream& draw);

}  // namespace fidservo::selfcheck
