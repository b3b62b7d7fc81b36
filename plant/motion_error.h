// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Error tolerances for the integration of a carriage's motion.
#include "plant/dormand_prince.h"

#include <cmath>

namespace fidservo::plant {

/// Tolerated error of one step. At a thousand steps a second the errors add up to less than 0.001 counts per
/// second (a count is 50 um).
inline constexpr double step_place_tolerance_mm = 1e-8, step_speed_tolerance_mm_per_s = 1e-6;

/// The largest error of a step in units of its tolerance; NaN if any error is NaN. Positions and speeds
/// alternate.
template <std::size_t size>
double error_of(const RungeKuttaStep<size>& step) {
    double worst = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
        const double tolerance = i % 2 == 0 ? step_place_tolerance_mm : step_speed_tolerance_mm_per_s;
        const double error = std::abs(step.error[i]) / tolerance;
        if (!(error <= worst)) worst = error;
    }
    return worst;
}

}  // namespace fidservo::plant
