// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/view/disc.h"

#include "plant/view/gaussian.h"

#include <algorithm>
#include <cmath>

namespace fidservo::plant::view {

namespace {

constexpr double nodes_per_px = 32.0;
constexpr double disc_reach_in_sigmas = 4.5;

/// G(r) by Simpson's rule in the angle t with x = R sin t, which takes the square root out of the integrand.
double disc_coverage(double r, double R, double sigma) {
    const double low = std::clamp((r - 6.0 * sigma) / R, -1.0, 1.0);
    const double high = std::clamp((r + 6.0 * sigma) / R, -1.0, 1.0);
    const double start = std::asin(low), span = std::asin(high) - start;
    const auto integrand = [&](double t) {
        const double half_chord = R * std::cos(t);
        return normal_density((r - R * std::sin(t)) / sigma) / sigma *
               (2.0 * normal_cdf(half_chord / sigma) - 1.0) * half_chord;
    };
    constexpr int panels = 64;
    double sum = integrand(start) + integrand(start + span);
    for (int k = 1; k < panels; ++k) sum += (k % 2 == 1 ? 4.0 : 2.0) * integrand(start + span * k / panels);
    return sum * span / (3.0 * panels);
}

}  // namespace

Disc::Disc(double diameter_px, double sigma_px)
    : inner_px_(std::max(0.0, 0.5 * diameter_px - disc_reach_in_sigmas * sigma_px)),
      outer_px_(0.5 * diameter_px + disc_reach_in_sigmas * sigma_px) {
    const auto nodes = static_cast<int>(std::ceil((outer_px_ - inner_px_) * nodes_per_px)) + 2;
    for (int k = 0; k < nodes; ++k) {
        const double r = inner_px_ + k / nodes_per_px;
        table_.push_back(static_cast<float>(disc_coverage(r, 0.5 * diameter_px, sigma_px)));
    }
}

float Disc::covered(double r_squared) const {
    if (r_squared >= outer_px_ * outer_px_) return 0.0F;
    if (r_squared < inner_px_ * inner_px_) return 1.0F;
    const double x = (std::sqrt(r_squared) - inner_px_) * nodes_per_px;
    const auto node = static_cast<int>(x);
    return table_[node] + static_cast<float>(x - node) * (table_[node + 1] - table_[node]);
}

void Disc::cover(double du, double dv, std::span<float> coverage) const {
    const double dv_squared = dv * dv;
    for (float& value : coverage) {
        value = covered(du * du + dv_squared);
        du += 1.0;
    }
}

void Disc::cover_at(std::span<const double> du, std::span<const double> dv, std::span<float> coverage) const {
    for (std::size_t k = 0; k < coverage.size(); ++k) coverage[k] = covered(du[k] * du[k] + dv[k] * dv[k]);
}

}  // namespace fidservo::plant::view
