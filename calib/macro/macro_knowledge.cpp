// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_knowledge.h"

#include "calib/macro/macro_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::calib {

std::vector<std::size_t> contradicted(const MacroKnowledge& known) {
    constexpr double level = 0.01;
    double tested = 0.0;
    for (const MacroAgreement& figure : known.agreement) tested += figure.own.size() > 1 ? 1.0 : 0.0;
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < known.agreement.size(); ++i)
        if (known.agreement[i].own.size() > 1 && known.agreement[i].scatter.probability < level / tested)
            found.push_back(i);
    return found;
}

namespace {

/// A model that is common to recordings which contradict each other on one figure is wrong on the others too:
/// each figure is the mean of what the recordings say by themselves.
void take_means_of_recordings(MacroKnowledge& known) {
    if (contradicted(known).empty()) return;
    for (int i = 0; i < macro_figure_count; ++i) {
        const MacroAgreement& agreement = known.agreement[static_cast<std::size_t>(i)];
        if (agreement.own.size() < 2) continue;
        known.value[i] = agreement.scatter.mean;
        VarianceSum& sum = known.variance[static_cast<std::size_t>(i)] = {};
        sum.add(agreement.scatter.mean_variance, agreement.scatter.added_freedom);
    }
}

/// What taking friction or offset as zero may have done to a figure: its shift from the model that had them,
/// weighted by that model's weight (Akaike's, as in shift_variance()).
double variance_of_assumption(const MacroFit& fit, const MacroVector& gradient) {
    double variance = 0.0;
    for (const auto& dropped : {fit.friction_dropped, fit.offset_dropped}) {
        if (!dropped) continue;
        const double odds = std::exp(0.5 * std::pow(dropped->value / dropped->std, 2) - 1.0);
        const MacroVector shift = vector_of(dropped->with) - vector_of(fit.point.motion);
        variance += odds / (1.0 + odds) * std::pow(gradient.dot(shift), 2);
    }
    return variance;
}

/// The interval's true width over that of the standard error, of the figures that a short motion leaves open
/// to one side: the others go with the parameters in proportion.
double widening(const MacroEstimator& estimator, const MacroFit& fit, MacroFigure figure) {
    if (figure == MacroFigure::time_constant)
        return profile_widening(estimator, fit, macro_index::log_time_constant);
    if (figure == MacroFigure::gain)
        return profile_widening(estimator, fit,
                                fit.active[macro_index::speed] ? macro_index::speed : macro_index::slope);
    return 1.0;
}

}  // namespace

MacroKnowledge knowledge_of(const MacroEstimator& estimator, const MacroFit& fit, const MacroBuild& build,
                            double threshold_V, double threshold_std_V) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const MacroMotion& motion = fit.point.motion;
    MacroKnowledge known{figures_of(motion, build.unit_V, threshold_V), {}, {}, {}, {}, {}, {}};
    known.most_std = largest_useful_std(known.value, estimator.fastest_mm_per_s(),
                                        mean_drive_V(estimator.windows(), motion));
    known.agreement = macro_agreement(estimator, fit, build.unit_V, threshold_V);
    known.lacks = lacks_of(estimator, fit);
    known.missed = missed_share(estimator, fit, known.lacks.drive_squares_count2);
    const double named = known.lacks.found.empty() ? 0.0 : known.lacks.found.front().share;
    double ticks = 0.0;
    for (const MacroWindow& window : estimator.windows())
        ticks += static_cast<double>(window.position_mm.size());
    const MacroFigureGradient gradient = figure_gradient(motion, build.unit_V, threshold_V);
    for (int i = 0; i < macro_figure_count; ++i) {
        VarianceSum& sum = known.variance[static_cast<std::size_t>(i)];
        const MacroVector along = gradient.row(i).transpose();
        const BatchVariance batches = variance_along(fit.influences, along);
        const double wider = widening(estimator, fit, static_cast<MacroFigure>(i));
        sum.add(batches.variance * wider * wider, batches.freedom);
        known.systematic[i] = std::sqrt(ticks * known.missed.beyond_noise * (1.0 - named) *
                                        along.dot(fit.influences.inverse * along));
        const Heterogeneity& scatter = known.agreement[static_cast<std::size_t>(i)].scatter;
        if (scatter.added_variance > 0.0) sum.add(scatter.added_variance, scatter.added_freedom);
        sum.add(variance_of_assumption(fit, along), infinity);
        sum.add(shift_variance(known.lacks.found, along), infinity);
    }
    const auto zone_offset = static_cast<std::size_t>(MacroFigure::zone_offset);
    known.variance[zone_offset].add(
        std::pow(known.value[static_cast<int>(MacroFigure::zone_slope)] * threshold_std_V, 2), infinity);
    take_means_of_recordings(known);
    return known;
}

MacroEstimate estimate_of(const MacroKnowledge& known, MacroFigure figure) {
    const VarianceSum& sum = known.variance[static_cast<std::size_t>(figure)];
    return {known.value[static_cast<int>(figure)], std::sqrt(std::max(0.0, sum.variance)), sum.freedom,
            known.systematic[static_cast<int>(figure)]};
}

}  // namespace fidservo::calib
