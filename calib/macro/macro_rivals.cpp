// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_rivals.h"

#include <algorithm>
#include <cmath>

namespace fidservo::calib {

namespace {

constexpr std::size_t most_windows = 60;
constexpr int most_iterations = 200;

bool differs(const MacroEstimator& estimator, const MacroFit& fit, const MacroMotion& other, double drive_V) {
    constexpr double share = 0.2, errors = 4.0;
    const MacroVector here = vector_of(fit.point.motion), there = vector_of(other);
    const MacroVector size{std::abs(here[macro_index::speed]), std::abs(here[macro_index::slope]),
                           estimator.fastest_mm_per_s(), drive_V, 1.0};
    for (int i = 0; i < macro_parameter_count; ++i)
        if (fit.active[static_cast<std::size_t>(i)] &&
            std::abs(there[i] - here[i]) > std::max(share * size[i], errors * parameter_std(fit, i)))
            return true;
    return false;
}

/// Whether the loss half way between is above both: not one valley in which a search has not ended.
bool ridge_between(const MacroEstimator& estimator, const MacroPoint& a, const MacroPoint& b) {
    MacroPoint between = a;
    between.motion = with_parameters(a.motion, 0.5 * (vector_of(a.motion) + vector_of(b.motion)));
    estimator.refine(between, {}, most_iterations);
    return estimator.loss(between) > std::max(estimator.loss(a), estimator.loss(b));
}

}  // namespace

std::vector<MacroMinimum> other_minima(const MacroEstimator& estimator, const MacroFit& fit) {
    const std::size_t stride = (estimator.windows().size() + most_windows - 1) / most_windows;
    std::vector<MacroWindow> some;
    for (std::size_t w = 0; w < estimator.windows().size(); w += stride)
        some.push_back(estimator.windows()[w]);
    const MacroEstimator thinned(some, estimator.resolution_mm());
    const double drive_V = mean_drive_V(estimator.windows(), fit.point.motion);
    const double here = estimator.loss(fit.point);
    std::vector<MacroMinimum> found;
    for (const double factor : {0.01, 0.1, 0.3, 3.0, 10.0, 100.0}) {
        MacroMotion motion = fit.point.motion;
        motion.time_constant_s *= factor;
        // What the drive does to a carriage at rest at first stays as it is.
        motion.speed_mm_per_s *= factor;
        motion.slope_mm_per_s_per_V *= factor;
        motion.friction_mm_per_s *= factor;
        MacroPoint point = thinned.start_at(motion);
        point.noise_count = fit.point.noise_count;
        thinned.refine(point, fit.active, most_iterations);
        if (!differs(estimator, fit, point.motion, drive_V)) continue;
        MacroPoint all = estimator.start_at(point.motion);
        all.noise_count = fit.point.noise_count;
        estimator.refine(all, fit.active, most_iterations);
        const bool known = std::ranges::any_of(found, [&](const MacroMinimum& minimum) {
            MacroFit same = fit;
            same.point.motion = minimum.point.motion;
            return !differs(estimator, same, all.motion, drive_V);
        });
        if (known || !differs(estimator, fit, all.motion, drive_V)) continue;
        if (!ridge_between(estimator, fit.point, all)) continue;
        const double above = estimator.loss(all) - here;
        if (std::isfinite(above)) found.push_back({std::move(all), above});
    }
    std::ranges::sort(found, {}, &MacroMinimum::above);
    return found;
}

}  // namespace fidservo::calib
