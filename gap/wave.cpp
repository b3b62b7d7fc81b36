#include "gap/wave.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fidservo::gap {

std::optional<WaveParameters> wave_of(const plant::Effect& effect) {
    const auto place_of = [&](plant::Role role) {
        const auto found = std::ranges::find(effect.parameters, role, &plant::EffectParameter::role);
        return static_cast<std::size_t>(found - effect.parameters.begin());
    };
    const WaveParameters wave{place_of(plant::Role::size), place_of(plant::Role::period),
                              place_of(plant::Role::phase), effect.part == plant::Part::carriage};
    if (wave.period == effect.parameters.size()) return {};
    return wave;
}

double phase_in_step(double phase_rad, double from_period_mm, double to_period_mm) {
    constexpr double middle_mm = 100.0;
    const double turned_rad =
        2.0 * std::numbers::pi * middle_mm * (1.0 / to_period_mm - 1.0 / from_period_mm);
    return std::remainder(phase_rad - turned_rad, 2.0 * std::numbers::pi);
}

}  // namespace fidservo::gap
