// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where the dead zone ends, per direction. The recorded commands take discrete values, so the data tell
// between which two of them the threshold lies and cannot tell more.
#include "calib/macro/macro_estimator.h"

namespace fidservo::calib {

/// The threshold lies above `above_V`, which did not drive, and at or below `most_V`, which did. `most_V` is
/// infinite where nothing drove in that direction, `above_V` is 0 where no smaller command was tried.
struct ThresholdInterval {
    double above_V = 0.0;
    double most_V = 0.0;

    bool bounded() const;
    double middle_V() const { return 0.5 * (above_V + most_V); }
    double std_V() const;  ///< of a uniform law over the interval
};

/// By what the carriage did from rest: the largest command that was held for 25 ms without a count, and the
/// smallest that had been reached when the first count of a motion came. A first guess, from readings alone.
/// @param side  +1 for commands to the right, -1 to the left
ThresholdInterval threshold_from_rest(const std::vector<MacroWindow>& windows, double resolution_mm,
                                      double side);

/// Moves both thresholds among the command levels to where the likelihood is greatest, the active parameters
/// refitted at every move: speeds, starts and thresholds make up for each other. Steps of one direction and
/// of both, from many levels down to one.
void search_thresholds(const MacroEstimator& estimator, MacroPoint& point, const MacroActive& active);

/// The commands between which one direction's threshold lies: over which the loss, refitted, does not exceed
/// its least by more than an allowance (2, for a likelihood of independent errors, is about two standard
/// deviations).
ThresholdInterval threshold_interval(const MacroEstimator& estimator, const MacroPoint& point,
                                     const MacroActive& active, double side, double allowance);

}  // namespace fidservo::calib
