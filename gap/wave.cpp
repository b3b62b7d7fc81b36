#include "gap/wave.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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
    return WaveParameters{place(amplitude), place(period), place(phase), amplitude->unit == "V"};
}

double phase_in_step(double phase_rad, double from_period_mm, double to_period_mm) {
    constexpr double middle_mm = 100.0;
    const double turned_rad =
        2.0 * std::numbers::pi * middle_mm * (1.0 / to_period_mm - 1.0 / from_period_mm);
    return std::remainder(phase_rad - turned_rad, 2.0 * std::numbers::pi);
}

}  // namespace fidservo::gap
