// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One model of the macro stage for all windows of one length: which parameters the windows can separate,
// their values, and between which command levels the thresholds lie.
#include "calib/macro/macro_estimator.h"
#include "calib/macro/macro_identification.h"
#include "calib/macro/macro_threshold.h"
#include "core/result.h"

#include <optional>
#include <span>
#include <vector>

namespace fidservo::calib {

struct MacroFit {
    MacroPoint point;
    MacroActive active{};  ///< a friction or offset that is not active is taken as zero
    ThresholdInterval forward, backward;
    MacroInfluences influences;
    bool both_ways = false;  ///< the carriage was driven to both sides
    /// The carriage was driven to one side only, and faster than the command alone explains. Offset and
    /// friction cannot be separated then: the fitted offset is offset minus friction, and friction is not
    /// fitted.
    bool offset_less_friction = false;
    /// The value of friction (mm/s) or offset (V) before it was removed from the fit, and the model with it.
    struct Dropped {
        double value, std;
        MacroMotion with;
    };
    std::optional<Dropped> friction_dropped, offset_dropped;
    bool friction_at_bound = false;  ///< friction would be negative without its bound of 0
    /// Other minima of the loss that are compatible with the data.
    std::vector<MacroMotion> rivals;
};

/// The windows of all traces in which the carriage moves freely; the traces must outlive them.
std::vector<MacroWindow> macro_windows(std::span<const MacroTrace> traces, const MacroBuild& build,
                                       double window_s);

/// Fails with Reason::not_identifiable where nothing can be fitted: no window, no command, or no motion.
Status check_macro_windows(const std::vector<MacroWindow>& windows, double resolution_mm);

/// Parameter values are compatible with the data if their loss exceeds the minimum by at most this. It is 2
/// for a likelihood of independent errors, and larger by the factor by which the likelihood understates the
/// parameters' variance (Kent, Robust properties of likelihood ratio tests, Biometrika 69(1), 1982).
double loss_allowance(const MacroFit& fit);

/// Standard deviation of one parameter.
double parameter_std(const MacroFit& fit, int index);

/// Mean absolute value of the commands that drive the carriage.
double mean_drive_V(const std::vector<MacroWindow>& windows, const MacroMotion& motion);

/// Fits parameters and noise level alternately, from a start point, until neither changes any more; the
/// thresholds keep their values.
void refine_with_noise(const MacroEstimator& estimator, MacroPoint& point, const MacroActive& active);

/// Fits all windows. Friction and offset are removed from the fit (set to zero) where their standard errors
/// exceed a fifth of the largest speed or of the mean driving command and they do not differ from zero at a
/// level of 1 %; an offset also where the carriage was driven to one side only.
MacroFit fit_macro_windows(const MacroEstimator& estimator, const MacroBuild& build);

/// Looks for other minima. A better one replaces the fit; those that are compatible with the data are kept as
/// its rivals.
void compare_minima(const MacroEstimator& estimator, const MacroBuild& build, MacroFit& fit);

}  // namespace fidservo::calib
