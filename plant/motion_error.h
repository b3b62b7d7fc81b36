// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How exactly a carriage's motion is integrated.
#include "plant/dormand_prince.h"

#include <cmath>

namespace fidservo::plant {

/// Error of one step. With a thousand steps a second it adds up to less than 0.001 counts of 50 um a second.
inline constexpr double step_place_tolerance_mm = 1e-8, step_speed_tolerance_mm_per_s = 1e-6;

/// Of a step of places and speeds in turn, the largest error over its tolerance; NaN where one is.
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
