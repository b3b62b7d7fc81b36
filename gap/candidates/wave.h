// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Effects that are periodic along the rail, A sin(2 pi y / p + phase) of the position y.
#include "plant/effects/effect.h"

#include <cstddef>
#include <optional>

namespace fidservo::gap {

/// The shortest period of a force along the rail that is searched for; a belt's teeth are at least 2 mm
/// apart.
inline constexpr double shortest_wave_mm = 1.9;

/// A place about the middle of a rail, at which phases of waves are compared.
inline constexpr double rail_middle_mm = 100.0;

/// Indices of an effect's parameters for the wave.
struct WaveParameters {
    std::size_t amplitude, period, phase;
    bool is_force;  ///< it is a force; false: an error of the reading
};

/// The indices, for an effect with a period, a size and a phase; else empty.
std::optional<WaveParameters> wave_of(const plant::Effect& effect);

/// The phase with which a wave of another period agrees with the first one in the middle of the rail: a
/// change of period needs a change of phase (at the rail's left end).
double phase_in_step(double phase_rad, double from_period_mm, double to_period_mm);

}  // namespace fidservo::gap
