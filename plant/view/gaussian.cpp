// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/view/gaussian.h"

#include <array>
#include <cmath>
#include <numbers>

namespace fidservo::plant::view {

namespace {

/// Gauss-Legendre rule with ten points on [-1, 1]: abscissae and weights of the positive half.
struct Node {
    double x, weight;
};
constexpr std::array<Node, 5> legendre_10{{{0.1488743389816312, 0.2955242247147529},
                                           {0.4333953941292472, 0.2692667193099964},
                                           {0.6794095682990244, 0.2190863625159820},
                                           {0.8650633666889845, 0.1494513491505806},
                                           {0.9739065285171717, 0.0666713443086881}}};

}  // namespace

double normal_density(double x) {
    return std::exp(-0.5 * x * x) * (0.5 * std::numbers::sqrt2 * std::numbers::inv_sqrtpi);
}

double normal_cdf(double x) {
    return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

double normal_quantile(double p) {
    double low = -40.0, high = 40.0;
    for (int k = 0; k < 100; ++k) {
        const double middle = 0.5 * (low + high);
        (normal_cdf(middle) < p ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double bivariate_normal_cdf(double h, double k, double rho) {
    const auto integrand = [h, k](double r) {
        const double rest = 1.0 - r * r;
        return std::exp(-(h * h - 2.0 * r * h * k + k * k) / (2.0 * rest)) / std::sqrt(rest);
    };
    double sum = 0.0;
    for (const auto& [x, weight] : legendre_10) {
        sum += weight * (integrand(0.5 * rho * (1.0 + x)) + integrand(0.5 * rho * (1.0 - x)));
    }
    return normal_cdf(h) * normal_cdf(k) + 0.5 * rho * sum / (2.0 * std::numbers::pi);
}

}  // namespace fidservo::plant::view
