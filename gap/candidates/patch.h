// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Effects that are raised friction around a place on the rail.
#include "plant/effects/effect.h"

#include <cstddef>
#include <optional>

namespace fidservo::gap {

/// Which parameters of an effect are a patch's.
struct PatchParameters {
    std::size_t level, centre, width;
};

/// Of an effect that has a width along the rail, and with it a size and a place.
std::optional<PatchParameters> patch_of(const plant::Effect& effect);

}  // namespace fidservo::gap
