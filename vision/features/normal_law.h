// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The standard normal distribution.
#include <cmath>
#include <numbers>

namespace fidservo::vision {

inline double normal_density(double z) {
    return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
}
inline double normal_cdf(double z) {
    return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

/// The z that a standard normal value exceeds with probability `tail`, 1e-300 < tail < 1, by bisection.
inline double normal_exceeded(double tail) {
    double low = -40.0;
    double high = 40.0;
    for (int round = 0; round < 60; ++round) {
        const double middle = 0.5 * (low + high);
        (normal_cdf(-middle) > tail ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// Expectation of the maximum of n independent standard normal values (Blom 1958; to 1 % from n = 2 on).
inline double expected_greatest(double n) {
    return n < 2.0 ? 0.0 : normal_exceeded(0.625 / (n + 0.25));
}

}  // namespace fidservo::vision
