// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/tails.h"

#include "core/demand.h"

#include <algorithm>

#include <unsupported/Eigen/SpecialFunctions>

namespace fidservo::calib {

namespace {

/// Beyond it the laws are those of an infinite freedom within 1e-6.
constexpr double endless_freedom = 1e6;

}  // namespace

double mean_square_ratio_tail(double ratio, double above, double below) {
    FIDSERVO_DEMAND(ratio >= 0.0 && above > 0.0 && below > 0.0);
    const double a = std::min(above, endless_freedom), b = std::min(below, endless_freedom);
    const double share = 1.0 / (1.0 + a / b * ratio);
    return std::clamp(Eigen::numext::betainc(0.5 * b, 0.5 * a, share), 0.0, 1.0);
}

double student_bound(double freedom, double both_tails) {
    FIDSERVO_DEMAND(freedom > 0.0 && both_tails > 0.0 && both_tails < 1.0);
    constexpr int halvings = 60;
    double low = 0.0, high = 1.0;
    while (mean_square_ratio_tail(high * high, 1.0, freedom) > both_tails) high *= 2.0;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (low + high);
        (mean_square_ratio_tail(middle * middle, 1.0, freedom) > both_tails ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double student_95(double freedom) {
    constexpr double both_tails = 0.05;
    return student_bound(freedom, both_tails);
}

}  // namespace fidservo::calib
