// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The Hall readings without their noise, as far as the platform's motion allows.
//
// What is smoothed is the reading minus the rig file's model of it, which follows all that the heater makes
// the platform do at once. Through it a straight line is fitted at every row over 2h + 1 readings. h is the
// largest of 2, 4, .. 128 up to which the intervals (fit +- its standard deviation) of all smaller ones still
// meet (of 17 neighbours the median): the rule of Goldenshluger and Nemirovski, Math. Methods of Statistics
// 6, 1997. What the model does not know, a swing for instance, makes h small and is kept. Wider intervals
// keep less noise, and more of what is wrong with the model: with 2.5 standard deviations the tags of the
// practice campaign with airflow stay at 1.23 floors under the truth, with 1, and the stated std a quarter
// larger for that, at 1.02.
#include "gap/links/platform_link.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// Row by row; rows without a reading have what was before.
struct SmoothedReading {
    std::vector<double> reading_lsb;
    std::vector<double> std_lsb;
    std::vector<double> readings;  ///< in the line that gives a row's value
    /// The macro command (limited) that stood before the row, smoothed in the same way: what leaks from it
    /// into the reading leaks in this proportion into the smoothed one.
    std::vector<double> drive_V;
    std::vector<double> wire_degC;  ///< the wire's temperature by the rig file's model; empty: not known
};

/// @param path_lsb  the model of the reading, a value a row
/// @param command_limit_V  of the macro drive
SmoothedReading smoothed_reading(const PlatformRun& run, std::span<const double> path_lsb,
                                 double command_limit_V);

/// Standard deviation of what the error changes by from one row to another. Of means over m and n readings, c
/// of them the same, with noise of sigma each: sigma sqrt(1/m + 1/n - 2c/mn).
double changed_lsb(const SmoothedReading& reading, std::size_t from, std::size_t to);

}  // namespace fidservo::gap
