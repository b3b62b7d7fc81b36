// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Effects that are not in the catalogue and that no setting of one or two of its effects reproduces.
#include "core/random.h"
#include "src/selfcheck/draw/true_rig.h"

#include <span>
#include <string_view>

namespace fidservo::selfcheck {

struct UnlistedEffect {
    std::string_view name;
    std::string_view block;  ///< the block that a diagnosis should accuse
    double smallest, largest;
    void (*put)(TrueRig& rig, double size, NoiseStream& draw);
};

std::span<const UnlistedEffect> unlisted_effects();

}  // namespace fidservo::selfcheck
