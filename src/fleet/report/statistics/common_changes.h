// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// When many units change at one time.
//
// A unit is judged by what the others scatter by (within_scatter.h). Where most of them change at one time,
// that passes for scatter of each, and hides all of them. So what they have in common is looked at first:
//
//     y_ut = a_u + c_p + e_ut,   p the period of t, as long as diagnoses are usually apart
//
// c, by least squares, is the course that units share. It may scatter from period to period, as rooms are
// warmer and colder for all of them, and nothing else tells by how much; so it is judged as a single unit of
// unknown scale (change_points.h): it raises at most as many false alarms a year as one unit does, and none
// that rests on a single period.
//
// Where it has changed each unit is as likely as not to have changed, too: its step at that time was not
// looked for, and counts by its own odds (find_changes()). And units' series are cut there, as the level of
// each may be another one before and since; a unit that has not changed loses a few contrasts by that, and
// nothing else.
#include "src/fleet/report/statistics/change_points.h"
#include "src/fleet/report/statistics/point.h"

#include <span>
#include <vector>

namespace fidservo::fleet {

/// What units' common course says.
struct CommonChanges {
    std::vector<CommonStep> steps;
    /// The times at which series are to be cut, ascending: the interval of a common step, and a period more
    /// on either side, is cut into its periods; what follows the begin of a common trend into pairs of
    /// periods.
    std::vector<double> cuts;
};

/// @param units  the points of each unit, by time; units that no diagnosis names say nothing
/// @param period_weeks  usual time between two diagnoses
/// @param bound  alarm_bound()
CommonChanges common_changes(std::span<const std::vector<Point>> units, double period_weeks, double bound);

/// A unit's points by stretches between cuts; no stretch is empty.
std::vector<std::vector<Point>> stretches_of(std::span<const Point> points, std::span<const double> cuts);

}  // namespace fidservo::fleet
