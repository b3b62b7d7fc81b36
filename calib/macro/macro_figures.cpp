// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_figures.h"

#include <algorithm>
#include <cmath>

namespace fidservo::calib {

MacroFigures figures_of(const MacroMotion& motion, double unit_V, double threshold_V) {
    const auto line = [&](double size_V) {
        return motion.speed_mm_per_s + motion.slope_mm_per_s_per_V * (size_V - motion.centre_V);
    };
    const double gain = line(unit_V);
    return {gain,
            motion.time_constant_s,
            line(threshold_V) / gain,
            motion.slope_mm_per_s_per_V / gain,
            motion.friction_mm_per_s / gain,
            motion.offset_V};
}

MacroFigureGradient figure_gradient(const MacroMotion& motion, double unit_V, double threshold_V) {
    const MacroVector here = vector_of(motion);
    const auto at = [&](const MacroVector& parameters) {
        MacroMotion beside = with_parameters(motion, parameters);
        beside.friction_mm_per_s = parameters[macro_index::friction];
        return figures_of(beside, unit_V, threshold_V);
    };
    MacroFigureGradient gradient;
    for (int i = 0; i < macro_parameter_count; ++i) {
        const double step = 1e-6 * std::max(1e-3, std::abs(here[i]));
        MacroVector above = here, below = here;
        above[i] += step;
        below[i] -= step;
        gradient.col(i) = (at(above) - at(below)) / (2.0 * step);
    }
    return gradient;
}

MacroFigures largest_useful_std(const MacroFigures& value, double fastest_mm_per_s, double drive_V) {
    constexpr double fifth = 0.2;
    return fifth * MacroFigures{std::abs(value[0]),
                                value[1],
                                1.0,
                                std::abs(value[3]),
                                fastest_mm_per_s / std::max(std::abs(value[0]), 1e-12),
                                drive_V};
}

}  // namespace fidservo::calib
