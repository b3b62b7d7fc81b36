// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/rounding_likelihood.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fidservo::calib {

namespace {

constexpr double half_log_two_pi = 0.91893853320467274;

double density(double x) {
    return std::exp(-0.5 * x * x - half_log_two_pi);
}

double upper_tail(double x) {
    return 0.5 * std::erfc(x / std::numbers::sqrt2);
}

/// Rounding adds its variance to noise that spans many counts.
RoundingLoss normal_loss(double error, double noise) {
    const double precision = 1.0 / (noise * noise + 1.0 / 12.0);
    return {0.5 * error * error * precision - 0.5 * std::log(precision) + half_log_two_pi, error * precision,
            precision};
}

/// Far outside the count only its nearer edge matters: Q(x) ~ density(x) / x (1 - 1/x^2).
RoundingLoss far_loss(double x, double noise) {
    const double hazard = x + 1.0 / x - 2.0 / (x * x * x);
    return {0.5 * x * x + half_log_two_pi + std::log(hazard), hazard / noise,
            hazard * (hazard - x) / (noise * noise)};
}

}  // namespace

RoundingLoss rounding_loss(double error_count, double noise_count) {
    constexpr double wide_noise = 2.0, far = 6.0;
    if (noise_count > wide_noise) return normal_loss(error_count, noise_count);
    const double size = std::abs(error_count), side = std::copysign(1.0, error_count);
    const double near_edge = (size - 0.5) / noise_count, far_edge = (size + 0.5) / noise_count;
    if (near_edge > far) {
        RoundingLoss loss = far_loss(near_edge, noise_count);
        loss.slope *= side;
        return loss;
    }
    const double probability = upper_tail(near_edge) - upper_tail(far_edge);
    const double near_density = density(near_edge), far_density = density(far_edge);
    const double slope = (near_density - far_density) / (probability * noise_count);
    const double bend =
        (near_edge * near_density - far_edge * far_density) / (probability * noise_count * noise_count);
    return {-std::log(probability), side * slope, std::max(0.0, slope * slope - bend)};
}

}  // namespace fidservo::calib
