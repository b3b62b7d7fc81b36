#pragma once
// One model of the macro stage for all windows of one length: which parameters the windows can tell apart,
// their values, the thresholds between command levels.
#include "calib/axis/macro_estimator.h"
#include "calib/axis/macro_identification.h"
#include "calib/axis/macro_threshold.h"
#include "core/result.h"

#include <span>
#include <vector>

namespace fidservo::calib {

struct MacroFit {
    MacroPoint point;
    MacroActive active{};  ///< a friction or offset that is not active is taken as zero
    ThresholdInterval forward, backward;
    MacroMatrix covariance = MacroMatrix::Zero();
    bool both_ways = false;  ///< driven to both sides
};

/// Free pieces of all traces; what they show must outlive them.
std::vector<MacroWindow> macro_windows(std::span<const MacroTrace> traces, const MacroBuild& build,
                                       double window_s);

/// Fails with Reason::not_identifiable where there is nothing to fit: no window, no command, no motion.
Status check_macro_windows(const std::vector<MacroWindow>& windows, double resolution_mm);

/// Friction and offset leave the fit, and are zero, where their standard errors exceed a fifth of the largest
/// speed or of the mean driving command; an offset also where the carriage was driven to one side only.
MacroFit fit_macro_windows(const MacroEstimator& estimator, const MacroBuild& build);

}  // namespace fidservo::calib
