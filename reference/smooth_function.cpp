// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/smooth_function.h"

#include "core/demand.h"

#include <cmath>

namespace fidservo::reference {
namespace {

double cosines(const SmoothFunction& function, double u) {
    double sum = 0.0;
    for (std::size_t i = 0; i < smooth_waves; ++i)
        sum += std::cos(function.wave_numbers[i] * u + function.phases_rad[i]);
    return sum;
}

}  // namespace

double SmoothFunction::operator()(double x) const {
    if (size == 0.0) return 0.0;
    const double u = (2.0 * x - low - high) / (high - low);
    return size * (amplitude * cosines(*this, u) - (offset + slope * u));
}

SmoothFunction smooth_function(double size, double low, double high,
                               const std::array<double, smooth_waves>& wave_numbers,
                               const std::array<double, smooth_waves>& phases_rad) {
    FIDSERVO_DEMAND(high > low);
    SmoothFunction function{.size = size,
                            .low = low,
                            .high = high,
                            .amplitude = 1.0,
                            .wave_numbers = wave_numbers,
                            .phases_rad = phases_rad};
    constexpr int points = 401;
    double mean = 0.0, moment = 0.0, square = 0.0, square_of_u = 0.0;
    for (int k = 0; k < points; ++k) {
        const double u = (2.0 * k + 1.0) / points - 1.0, sum = cosines(function, u);
        mean += sum / points;
        moment += u * sum / points;
        square += sum * sum / points;
        square_of_u += u * u / points;
    }
    const double slope = moment / square_of_u;
    function.amplitude = 1.0 / std::sqrt(square - mean * mean - slope * moment);
    function.offset = function.amplitude * mean;
    function.slope = function.amplitude * slope;
    return function;
}

}  // namespace fidservo::reference
