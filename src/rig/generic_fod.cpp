// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/rig/generic_fod.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fidservo {

namespace {

constexpr double centre_degC = 79.0, slope_degC = 4.5;
constexpr double least_width_degC = 15.0, most_width_degC = 35.0;

/// h / stroke, and its integral over temperature.
double heated(double temp_degC) {
    return 1.0 / (1.0 + std::exp(-(temp_degC - centre_degC) / slope_degC));
}
double heated_integral(double temp_degC) {
    return slope_degC * std::log1p(std::exp((temp_degC - centre_degC) / slope_degC));
}

double cooled(double peak_degC, double temp_degC) {
    const double from_degC = temp_degC + least_width_degC, to_degC = temp_degC + most_width_degC;
    const double below =
        heated_integral(std::min(peak_degC, to_degC)) - heated_integral(std::min(peak_degC, from_degC));
    const double beyond_degC = std::max(0.0, to_degC - peak_degC) - std::max(0.0, from_degC - peak_degC);
    return (below + beyond_degC * heated(peak_degC)) / (most_width_degC - least_width_degC);
}

}  // namespace

FodTable generic_fod(double stroke_mm) {
    constexpr double low_degC = 10.0, step_degC = 2.0;
    constexpr int nodes = 56;
    std::vector<double> temperatures, contractions;
    for (int i = 0; i < nodes; ++i) {
        temperatures.push_back(low_degC + step_degC * i);
        for (int j = 0; j <= i; ++j)
            contractions.push_back(stroke_mm * cooled(temperatures[static_cast<std::size_t>(i)],
                                                      temperatures[static_cast<std::size_t>(j)]));
    }
    return FodTable(std::move(temperatures), contractions);
}

}  // namespace fidservo
