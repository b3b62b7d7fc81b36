// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One model of the macro stage for all windows of one length: which parameters the windows can tell apart,
// their values, the thresholds between command levels.
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
    bool both_ways = false;  ///< driven to both sides
    /// Driven to one side, by more than the command: the offset in the fit is net of friction, which is not
    /// in it.
    bool offset_less_friction = false;
    /// What friction (mm/s) and offset (V) were when they left the fit, and the model that had them.
    struct Dropped {
        double value, std;
        MacroMotion with;
    };
    std::optional<Dropped> friction_dropped, offset_dropped;
    bool friction_at_bound = false;  ///< the fit would have it below 0
    /// Other minima of the loss that the data do not exclude.
    std::vector<MacroMotion> rivals;
};

/// Free pieces of all traces; what they show must outlive them.
std::vector<MacroWindow> macro_windows(std::span<const MacroTrace> traces, const MacroBuild& build,
                                       double window_s);

/// Fails with Reason::not_identifiable where there is nothing to fit: no window, no command, no motion.
Status check_macro_windows(const std::vector<MacroWindow>& windows, double resolution_mm);

/// By how much the loss may exceed its minimum at values that the data do not exclude: 2 for a likelihood of
/// independent errors, more as its own claim is short of the parameters' variance (Kent, Robust properties of
/// likelihood ratio tests, Biometrika 69(1), 1982).
double loss_allowance(const MacroFit& fit);

/// Root of the variance of one parameter.
double parameter_std(const MacroFit& fit, int index);

/// Mean size of the commands that drive.
double mean_drive_V(const std::vector<MacroWindow>& windows, const MacroMotion& motion);

/// Parameters and noise in turn, from a point, until neither changes any more; thresholds stay.
void refine_with_noise(const MacroEstimator& estimator, MacroPoint& point, const MacroActive& active);

/// Friction and offset leave the fit, and are zero, where their standard errors exceed a fifth of the largest
/// speed or of the mean driving command and they do not differ from zero at a level of 1 %; an offset also
/// where the carriage was driven to one side only.
MacroFit fit_macro_windows(const MacroEstimator& estimator, const MacroBuild& build);

/// Another minimum takes the place of a fit that it is better than; those that the data do not exclude are
/// kept as its rivals.
void compare_minima(const MacroEstimator& estimator, const MacroBuild& build, MacroFit& fit);

}  // namespace fidservo::calib
