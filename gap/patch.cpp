#include "gap/patch.h"

#include <algorithm>

namespace fidservo::gap {

std::optional<PatchParameters> patch_of(const plant::Effect& effect) {
    const auto place_of = [&](plant::Role role) {
        const auto found = std::ranges::find(effect.parameters, role, &plant::EffectParameter::role);
        return static_cast<std::size_t>(found - effect.parameters.begin());
    };
    const PatchParameters patch{place_of(plant::Role::size), place_of(plant::Role::place),
                                place_of(plant::Role::width)};
    if (patch.width == effect.parameters.size()) return {};
    return patch;
}

}  // namespace fidservo::gap
