// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_profile.h"

#include "calib/tails.h"
#include "core/demand.h"

#include <algorithm>
#include <cmath>

namespace fidservo::calib {

namespace {

constexpr double farthest = 100.0;

/// Least loss with one parameter held `away` from where the fit has it, above that of the fit.
double profile_rise(const MacroEstimator& estimator, const MacroFit& fit, int index, double away) {
    constexpr int iterations = 30;
    MacroActive others = fit.active;
    others[static_cast<std::size_t>(index)] = false;
    if (fit.active[macro_index::speed]) others[macro_index::friction] = false;
    MacroPoint point = fit.point;
    MacroVector parameters = vector_of(fit.point.motion);
    parameters[index] += away;
    point.motion = with_parameters(point.motion, parameters);
    estimator.refine(point, others, iterations);
    return estimator.loss(point) - estimator.loss(fit.point);
}

/// Where the profile has risen by as much as a parabola has at 1, in units of `reach`; at least 1.
double end_of_interval(const MacroEstimator& estimator, const MacroFit& fit, int index, double reach,
                       double rise_at_end) {
    constexpr double step = 1.5;
    double below = 0.0, root_below = 0.0;
    for (double share = 1.0; share < farthest; share *= step) {
        const double rise = profile_rise(estimator, fit, index, share * reach);
        const double root = std::sqrt(std::max(0.0, rise / rise_at_end));
        if (!std::isfinite(root)) return std::max(1.0, share);
        if (root >= 1.0)
            return std::max(1.0, below + (share - below) * (1.0 - root_below) / (root - root_below));
        below = share;
        root_below = root;
    }
    return farthest;
}

}  // namespace

double profile_widening(const MacroEstimator& estimator, const MacroFit& fit, int index) {
    FIDSERVO_DEMAND(fit.active[static_cast<std::size_t>(index)]);
    const BatchVariance variance = variance_along(fit.influences, MacroVector::Unit(index));
    // In standard errors of a normal law; Student's reach as much farther as it does at 95 %.
    constexpr double far = 4.0;
    const double claimed = fit.influences.inverse(index, index),
                 reached = far / normal_95 * student_95(variance.freedom);
    if (!(claimed > 0.0) || !std::isfinite(variance.variance)) return 1.0;
    const double reach = reached * std::sqrt(variance.variance);
    const double rise = 0.5 * reached * reached * variance.variance / claimed;
    const double above = end_of_interval(estimator, fit, index, +reach, rise),
                 below = end_of_interval(estimator, fit, index, -reach, rise);
    if (index != macro_index::log_time_constant) return std::max(above, below);
    return std::clamp(std::max(std::expm1(above * reach), -std::expm1(-below * reach)) / reach, 1.0,
                      farthest);
}

}  // namespace fidservo::calib
