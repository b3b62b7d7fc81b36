// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/candidates/patch.h"

namespace fidservo::gap {

std::optional<PatchParameters> patch_of(const plant::Effect& effect) {
    const auto size = effect.place_of(plant::Role::size), place = effect.place_of(plant::Role::place),
               width = effect.place_of(plant::Role::width);
    if (!size || !place || !width) return {};
    return PatchParameters{*size, *place, *width};
}

}  // namespace fidservo::gap
