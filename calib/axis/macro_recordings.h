#pragma once
// What each recording alone says of the macro stage, and whether they agree.
#include "calib/axis/macro_figures.h"

#include <array>
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

/// How much of the motion the model misses: r.m.s. over held-out windows of prediction minus reading, over
/// the r.m.s. of what the drive and friction must explain, the motion less the steady one that fits the
/// window best; rounding's variance is taken out of both. The model is fitted to every other window and
/// judged by the rest, then the other way round. Empty where the motion is steady within rounding, or there
/// are less than two windows.
std::optional<double> missed_share(const MacroEstimator& estimator, const MacroFit& fit);

/// How often the carriage turned round, by more than four counts each way, and how long it coasted: moved
/// at a tenth of its largest speed or faster while nothing drove it.
struct MacroManoeuvres {
    int reversals = 0;
    double coasted_s = 0.0;
};
MacroManoeuvres manoeuvres(const MacroEstimator& estimator, const MacroMotion& motion);

}  // namespace fidservo::calib
