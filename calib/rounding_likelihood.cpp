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

constexpr double wide_noise = 2.0, far = 6.0;

/// Where a position lies, in standard deviations of the noise beyond the two edges of a count.
struct Edges {
    double near, far;

    Edges(double error_count, double noise_count)
        : near((std::abs(error_count) - 0.5) / noise_count),
          far((std::abs(error_count) + 0.5) / noise_count) {}

    /// Whether what lies beyond the far edge is less than rounding of the rest.
    bool is_one_sided() const {
        constexpr double never = 9.0, less_than_rounding = 80.0;  // Q(9) = 1e-19, exp(-80 / 2) = 4e-18
        return far > never && (near <= 0.0 || far * far - near * near > less_than_rounding);
    }

    double probability() const { return upper_tail(near) - (is_one_sided() ? 0.0 : upper_tail(far)); }
};

}  // namespace

RoundingLoss rounding_loss(double error_count, double noise_count) {
    if (noise_count > wide_noise) return normal_loss(error_count, noise_count);
    const double side = std::copysign(1.0, error_count);
    const Edges edges(error_count, noise_count);
    if (edges.near > far) {
        RoundingLoss loss = far_loss(edges.near, noise_count);
        loss.slope *= side;
        return loss;
    }
    const double probability = edges.probability();
    const double near_density = density(edges.near),
                 far_density = edges.is_one_sided() ? 0.0 : density(edges.far);
    const double slope = (near_density - far_density) / (probability * noise_count);
    const double bend =
        (edges.near * near_density - edges.far * far_density) / (probability * noise_count * noise_count);
    return {-std::log(probability), side * slope, std::max(0.0, slope * slope - bend)};
}

double rounding_loss_value(double error_count, double noise_count) {
    const Edges edges(error_count, noise_count);
    if (noise_count > wide_noise || edges.near > far) return rounding_loss(error_count, noise_count).value;
    return -std::log(edges.probability());
}

}  // namespace fidservo::calib
