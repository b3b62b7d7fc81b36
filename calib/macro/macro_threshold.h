// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The end of the dead zone in each direction. The recorded commands take discrete values, so the data only
// show between which two of them a threshold lies.
#include "calib/macro/macro_estimator.h"

namespace fidservo::calib {

/// The threshold lies above `above_V`, which did not drive, and at or below `most_V`, which did. `most_V` is
/// infinite where nothing drove in that direction, `above_V` is 0 where no smaller command was tried.
struct ThresholdInterval {
    double above_V = 0.0;
    double most_V = 0.0;

    bool bounded() const;
    double middle_V() const { return 0.5 * (above_V + most_V); }
    double std_V() const;  ///< standard deviation of a uniform distribution over the interval
};

/// The threshold from motions that start at rest: it lies between the largest command that was held for 25 ms
/// without a change of count and the smallest command at which a motion's first change of count occurred. A
/// start value, which needs no model.
/// @param side  +1 for commands to the right, -1 to the left
ThresholdInterval threshold_from_rest(const std::vector<MacroWindow>& windows, double resolution_mm,
                                      double side);

/// Moves both thresholds among the command levels to the maximum of the likelihood. The active parameters are
/// refitted for every trial, as speeds, initial states and thresholds can compensate for each other. Trials
/// move one threshold or both, by many command levels at first and finally by one.
void search_thresholds(const MacroEstimator& estimator, MacroPoint& point, const MacroActive& active);

/// The interval of commands for one direction's threshold: where the loss, with everything else refitted,
/// exceeds its minimum by at most `allowance` (2, for a likelihood of independent errors, is about two
/// standard deviations).
ThresholdInterval threshold_interval(const MacroEstimator& estimator, const MacroPoint& point,
                                     const MacroActive& active, double side, double allowance);

}  // namespace fidservo::calib
