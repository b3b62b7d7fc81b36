// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Effects that are waves along the rail, A sin(2 pi y / p + phase) of the place y.
#include "plant/effects/effect.h"

#include <cstddef>
#include <optional>

namespace fidservo::gap {

/// The shortest period of a force along the rail that is looked for: a belt's teeth are 2 mm apart at least.
inline constexpr double shortest_wave_mm = 1.9;

/// Which parameters of an effect are a wave's.
struct WaveParameters {
    std::size_t amplitude, period, phase;
    bool is_force;  ///< else a reading is off
};

/// Of an effect that has a period, and with it a size and a phase.
std::optional<WaveParameters> wave_of(const plant::Effect& effect);

/// The phase with which a wave of another period is in step with the first in the middle of the rail: along
/// the ends period and phase have to be changed together.
double phase_in_step(double phase_rad, double from_period_mm, double to_period_mm);

}  // namespace fidservo::gap
