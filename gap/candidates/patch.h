// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Effects that are raised friction around a place on the rail (a patch).
#include "plant/effects/effect.h"

#include <cstddef>
#include <optional>

namespace fidservo::gap {

/// Indices of an effect's parameters for the patch.
struct PatchParameters {
    std::size_t level, centre, width;
};

/// The indices, for an effect with a width along the rail, a size and a place; else empty.
std::optional<PatchParameters> patch_of(const plant::Effect& effect);

}  // namespace fidservo::gap
