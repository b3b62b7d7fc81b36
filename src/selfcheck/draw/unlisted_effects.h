// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Effects that the catalogue lacks: no setting of a named effect, nor two of them, does what they do.
#include "core/random.h"
#include "src/selfcheck/draw/true_rig.h"

#include <span>
#include <string_view>

namespace fidservo::selfcheck {

struct UnlistedEffect {
    std::string_view name;
    std::string_view block;  ///< where a diagnosis should find it
    double smallest, largest;
    void (*put)(TrueRig& rig, double size, NoiseStream& draw);
};

std::span<const UnlistedEffect> unlisted_effects();

}  // namespace fidservo::selfcheck
