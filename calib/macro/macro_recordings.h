// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Estimates of the macro stage from each recording alone, and whether they agree.
#include "calib/macro/macro_figures.h"

#include <array>
#include <optional>
#include <vector>

namespace fidservo::calib {

/// A figure's estimates from the recordings that determine it by themselves.
struct MacroAgreement {
    std::vector<std::size_t> recordings;
    std::vector<RecordingEstimate> own;
    Heterogeneity scatter = {};
};

/// Fits each recording by itself, starting from the common solution, with the thresholds fixed. A figure of a
/// recording is left out if its standard error makes it useless (largest_useful_std), and an offset also if
/// the recording drives to one side only.
std::array<MacroAgreement, macro_figure_count> macro_agreement(const MacroEstimator& estimator,
                                                               const MacroFit& fit, double unit_V,
                                                               double threshold_V);

/// Neighbouring third differences of white noise are correlated: for an estimate of the variance, this number
/// of their squares is worth one independent square. It is 1 + 2 (15^2 + 6^2 + 1) / 20^2.
inline constexpr double third_differences_correlated = 2.31;

/// The fraction of the force that the model misses, measured by its double integral so that neither rounding
/// nor noise hides it: the r.m.s. of prediction minus reading over held-out windows, divided by the r.m.s. of
/// the motion that the drive causes, with the windows' initial states refitted. The variances of rounding and
/// of white noise, estimated from third differences, are subtracted. The model is fitted to every other
/// window and tested on the rest, then the other way round. Empty with less than two windows, or where the
/// motion that the drive causes is within noise.
struct MacroMissed {
    std::optional<double> share;
    double noise_count = 0.0;  ///< standard deviation of the white noise
    /// Fraction of the residual's sum of squares in excess of that noise, as far as it is significant at 1 %.
    double beyond_noise = 0.0;
};
MacroMissed missed_share(const MacroEstimator& estimator, const MacroFit& fit, double drive_squares_count2);

/// How often the carriage reversed, by more than four counts and six standard deviations of the readings'
/// noise in each direction, and how long it coasted: moved at a tenth of its largest speed or faster without
/// drive.
struct MacroManoeuvres {
    int reversals = 0;
    double coasted_s = 0.0;
};
MacroManoeuvres manoeuvres(const MacroEstimator& estimator, const MacroMotion& motion);

}  // namespace fidservo::calib
