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

/// Puts an effect of a class into a rig, in one of the ways to simulate it. Its size is between the largest
/// and 0.7 floors, or a 300th of the largest if that is more.
/// @return its label
TrueEffect put_listed(TrueRig& rig, std::string_view class_name, NoiseStream& draw);

}  // namespace fidservo::selfcheck
