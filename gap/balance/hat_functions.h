// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Piecewise linear basis functions over knots: each is 1 at its knot and 0 at all others.
#include "gap/numbers.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace fidservo::gap {

/// Knots at quantiles, with equally many values between neighbours.
/// @param values  sorted here
inline std::vector<double> knots_by_share(std::vector<float> values, std::size_t count) {
    std::vector<double> knots;
    if (values.empty()) return knots;
    std::ranges::sort(values);
    for (std::size_t k = 0; k < count; ++k) {
        const double knot = values[k * (values.size() - 1) / (count - 1)];
        if (knots.empty() || knot > knots.back() + next_to_nothing) knots.push_back(knot);
    }
    return knots;
}

/// Value of hat k at x; constant beyond the outer knots.
inline double hat(const std::vector<double>& knots, std::size_t k, double x) {
    if (k > 0 && x < knots[k]) return std::max(0.0, 1.0 - (knots[k] - x) / (knots[k] - knots[k - 1]));
    if (k + 1 < knots.size() && x > knots[k])
        return std::max(0.0, 1.0 - (x - knots[k]) / (knots[k + 1] - knots[k]));
    return 1.0;
}

}  // namespace fidservo::gap
