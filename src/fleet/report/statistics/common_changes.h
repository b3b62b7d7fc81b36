// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Changes that many units have at one time.
//
// A unit is judged with the scatter of the other units (within_scatter.h). If most units change at one time,
// these changes increase the estimated scatter and hide each other. Therefore the common course c of all
// units is judged first:
//
//     y_ut = a_u + c_p + e_ut,   p the period of t, as long as diagnoses are usually apart
//
// c is estimated by least squares. It may scatter from period to period, as room temperature does for all
// units, by an amount that is not known from elsewhere. It is therefore judged like a single unit of unknown
// scale (change_points.h): it raises at most as many false alarms a year as one unit, and none that depends
// on a single period.
//
// At the time of a common change, each unit has even prior odds of a step, without a correction for the
// choice of the time (find_changes()). For the estimate of the scatter, the series of all units are cut at
// this time, since the level may differ before and after; for a unit that has not changed this only costs a
// few contrasts.
#include "src/fleet/report/statistics/change_points.h"
#include "src/fleet/report/statistics/point.h"

#include <span>
#include <vector>

namespace fidservo::fleet {

/// The changes of the units' common course.
struct CommonChanges {
    std::vector<CommonStep> steps;
    /// The times, in weeks, at which series are to be cut, ascending: at every period within the interval of
    /// a common step, extended by a period on either side; at every second period after the start of a common
    /// trend.
    std::vector<double> cuts;
};

/// @param units  the points of each unit, by time; units without a diagnosis that names the quantity are
/// ignored
/// @param period_weeks  usual time between two diagnoses
/// @param bound  alarm_bound()
CommonChanges common_changes(std::span<const std::vector<Point>> units, double period_weeks, double bound);

/// A unit's points, divided at the cuts into stretches, none of which is empty.
std::vector<std::vector<Point>> stretches_of(std::span<const Point> points, std::span<const double> cuts);

}  // namespace fidservo::fleet
