// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What each recording alone says of the macro stage, and whether they agree.
#include "calib/macro/macro_figures.h"

#include <array>
#include <optional>
#include <vector>

namespace fidservo::calib {

/// One figure over the recordings that determine it by themselves.
struct MacroAgreement {
    std::vector<std::size_t> recordings;
    std::vector<RecordingEstimate> own;
    Heterogeneity scatter = {};
};

/// Each recording fitted by itself from the common solution on, the thresholds held. A recording is left out
/// of a figure that it leaves useless (largest_useful_std) or, for the offset, if it drives to one side only.
std::array<MacroAgreement, macro_figure_count> macro_agreement(const MacroEstimator& estimator,
                                                               const MacroFit& fit, double unit_V,
                                                               double threshold_V);

/// Squares of third differences of white noise that say as much of its variance as an independent one:
/// 1 + 2 (15^2 + 6^2 + 1) / 20^2.
inline constexpr double third_differences_correlated = 2.31;

/// How much of the force the model misses, integrated twice, which neither rounding nor noise drowns: r.m.s.
/// over held-out windows of prediction minus reading, over the r.m.s. of how far the drive moves the
/// carriage, the windows' starts having followed. The variance of noise that is white from tick to tick, as
/// third differences show it, and of rounding is taken out. The model is fitted to every other window and
/// judged by the rest, then the other way round. The share is empty with less than two windows, or where the
/// drive moves the carriage by no more than noise.
struct MacroMissed {
    std::optional<double> share;
    double noise_count = 0.0;  ///< standard deviation of that noise
    /// Share of the residual's squares that is beyond that noise, as far as that is significant at 1 %.
    double beyond_noise = 0.0;
};
MacroMissed missed_share(const MacroEstimator& estimator, const MacroFit& fit, double drive_squares_count2);

/// How often the carriage turned round, by more than four counts and six standard deviations of the
/// readings' noise each way, and how long it coasted: moved
/// at a tenth of its largest speed or faster while nothing drove it.
struct MacroManoeuvres {
    int reversals = 0;
    double coasted_s = 0.0;
};
MacroManoeuvres manoeuvres(const MacroEstimator& estimator, const MacroMotion& motion);

}  // namespace fidservo::calib
