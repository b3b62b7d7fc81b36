#include "gap/wave.h"

#include <algorithm>

namespace fidservo::gap {

std::optional<WaveParameters> wave_of(const plant::Effect& effect) {
    const auto& all = effect.parameters;
    const auto is_size = [](const plant::EffectParameter& p) { return p.vanishing != p.typical; };
    const auto place = [&](auto found) { return static_cast<std::size_t>(found - all.begin()); };
    const auto amplitude = std::ranges::find_if(all, is_size);
    const auto period =
        std::ranges::find_if(all, [&](const auto& p) { return !is_size(p) && p.unit == "mm"; });
    const auto phase = std::ranges::find(all, "rad", &plant::EffectParameter::unit);
    if (amplitude == all.end() || period == all.end() || phase == all.end()) return {};
    return WaveParameters{place(amplitude), place(period), place(phase)};
}

}  // namespace fidservo::gap
