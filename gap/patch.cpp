#include "gap/patch.h"

#include <algorithm>

namespace fidservo::gap {

std::optional<PatchParameters> patch_of(const plant::Effect& effect) {
    const auto& all = effect.parameters;
    const auto is_size = [](const plant::EffectParameter& p) { return p.vanishing != p.typical; };
    const auto is_length = [&](const plant::EffectParameter& p) { return !is_size(p) && p.unit == "mm"; };
    const auto place = [&](auto found) { return static_cast<std::size_t>(found - all.begin()); };
    const auto level = std::ranges::find_if(all, [&](const auto& p) { return is_size(p) && p.unit == "V"; });
    const auto centre = std::ranges::find_if(all, [&](const auto& p) { return is_length(p) && p.low < 0.0; });
    const auto width = std::ranges::find_if(all, [&](const auto& p) { return is_length(p) && p.low > 0.0; });
    if (level == all.end() || centre == all.end() || width == all.end()) return {};
    return PatchParameters{place(level), place(centre), place(width)};
}

}  // namespace fidservo::gap
