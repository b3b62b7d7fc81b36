// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/candidates/wave.h"

#include <cmath>
#include <numbers>

namespace fidservo::gap {

std::optional<WaveParameters> wave_of(const plant::Effect& effect) {
    const auto size = effect.place_of(plant::Role::size), period = effect.place_of(plant::Role::period),
               phase = effect.place_of(plant::Role::phase);
    if (!size || !period || !phase) return {};
    return WaveParameters{*size, *period, *phase, effect.part == plant::Part::carriage};
}

double phase_in_step(double phase_rad, double from_period_mm, double to_period_mm) {
    const double turned_rad =
        2.0 * std::numbers::pi * rail_middle_mm * (1.0 / to_period_mm - 1.0 / from_period_mm);
    return std::remainder(phase_rad - turned_rad, 2.0 * std::numbers::pi);
}

}  // namespace fidservo::gap
