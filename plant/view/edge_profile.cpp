// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/view/edge_profile.h"

#include "plant/view/gaussian.h"

#include <algorithm>
#include <cmath>

namespace fidservo::plant::view {

namespace {

constexpr double reach_in_sigmas = 4.5;

/// First integral of Phi(x / sigma) over x; a ramp for sigma = 0.
double ramp(double x, double sigma) {
    if (sigma == 0.0) return std::max(x, 0.0);
    return x * normal_cdf(x / sigma) + sigma * normal_density(x / sigma);
}

/// Second integral of Phi(x / sigma) over x; a half parabola for sigma = 0.
double parabola(double x, double sigma) {
    if (sigma == 0.0) return 0.5 * std::max(x, 0.0) * std::max(x, 0.0);
    return 0.5 * ((x * x + sigma * sigma) * normal_cdf(x / sigma) + x * sigma * normal_density(x / sigma));
}

}  // namespace

template <class Exact>
EdgeProfile::EdgeProfile(double reach_px, Exact exact)
    : reach_px_(std::ceil(reach_px * nodes_per_px) / nodes_per_px),
      last_node_(2.0 * reach_px_ * nodes_per_px) {
    table_.resize(static_cast<std::size_t>(last_node_) + 1);
    for (std::size_t node = 0; node < table_.size(); ++node) {
        table_[node] = exact(static_cast<double>(node) / nodes_per_px - reach_px_);
    }
}

EdgeProfile EdgeProfile::of_pixel(double blur_px, double angle_rad) {
    const double wide = std::max(std::abs(std::cos(angle_rad)), std::abs(std::sin(angle_rad)));
    const double narrow = std::min(std::abs(std::cos(angle_rad)), std::abs(std::sin(angle_rad)));
    const double reach = reach_in_sigmas * blur_px + 0.5 * (wide + narrow);
    if (narrow < 1e-4) {
        return {reach, [&](double d) {
                    return (ramp(d + 0.5 * wide, blur_px) - ramp(d - 0.5 * wide, blur_px)) / wide;
                }};
    }
    const double outer = 0.5 * (wide + narrow), inner = 0.5 * (wide - narrow);
    return {reach, [&](double d) {
                return (parabola(d + outer, blur_px) - parabola(d + inner, blur_px) -
                        parabola(d - inner, blur_px) + parabola(d - outer, blur_px)) /
                       (wide * narrow);
            }};
}

EdgeProfile EdgeProfile::gaussian(double sigma_px) {
    return {reach_in_sigmas * sigma_px, [sigma_px](double d) { return normal_cdf(d / sigma_px); }};
}

double blur_with_pixel_px(double blur_px) {
    return std::sqrt(blur_px * blur_px + 1.0 / 12.0);
}

}  // namespace fidservo::plant::view
