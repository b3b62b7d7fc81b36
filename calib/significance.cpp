// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/significance.h"

#include "core/demand.h"

#include <cmath>
#include <numbers>

namespace fidservo::calib {

double normal_bound(double tail) {
    FIDSERVO_DEMAND(tail > 0.0 && tail <= 0.5);
    // Newton on the logarithm of the tail, which is nearly a parabola.
    double z = std::sqrt(-2.0 * std::log(2.0 * tail));
    constexpr int steps = 12;
    for (int step = 0; step < steps; ++step) {
        const double above = 0.5 * std::erfc(z / std::numbers::sqrt2);
        const double density = std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
        z += std::log(above / tail) * above / density;
    }
    return z;
}

double chi_square_bound(double freedom, double tail) {
    FIDSERVO_DEMAND(freedom > 0.0);
    const double spread = 2.0 / (9.0 * freedom);
    return freedom * std::pow(1.0 - spread + normal_bound(tail) * std::sqrt(spread), 3.0);
}

double mean_square_ratio_bound(double above, double below, double tail) {
    FIDSERVO_DEMAND(above > 0.0 && below > 0.0);
    // (1 - b) x - (1 - a) = z sqrt(a + b x^2) for the bound's cube root x
    const double a = 2.0 / (9.0 * above), b = 2.0 / (9.0 * below), z = normal_bound(tail);
    const double square = (1.0 - b) * (1.0 - b) - z * z * b, middle = (1.0 - a) * (1.0 - b);
    const double rest = (1.0 - a) * (1.0 - a) - z * z * a;
    FIDSERVO_DEMAND(square > 0.0);
    return std::pow((middle + std::sqrt(middle * middle - square * rest)) / square, 3.0);
}

}  // namespace fidservo::calib
