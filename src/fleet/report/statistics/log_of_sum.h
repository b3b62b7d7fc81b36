// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace fidservo::fleet {

/// log(sum over k of exp(terms_k)), however large or small the terms are; of none, minus infinity.
inline double log_of_sum(std::span<const double> terms) {
    if (terms.empty()) return -std::numeric_limits<double>::infinity();
    const double largest = *std::ranges::max_element(terms);
    double sum = 0.0;
    for (const double term : terms) sum += std::exp(term - largest);
    return largest + std::log(sum);
}

}  // namespace fidservo::fleet
