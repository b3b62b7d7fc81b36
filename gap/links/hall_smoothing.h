// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The Hall readings with as little noise as the platform's motion allows.
//
// The difference between the reading and the rig file's model of it is smoothed, not the reading itself,
// since the model contains the fast motion that the heater causes. At every row a straight line is fitted to
// 2h + 1 differences. h is the largest of 2, 4, .. 128 for which the intervals (fit +- its standard
// deviation) of all h up to it have a point in common (then the median of 17 neighbours): the rule of
// Goldenshluger and Nemirovski, Math. Methods of Statistics 6, 1997. Motion that the model lacks, such as a
// swing, makes h small and is kept. Wider intervals would remove more noise, but also more of the motion that
// the model lacks. With intervals of 2.5 standard deviations, the tags of the practice campaign with airflow
// have errors of 1.23 floors under the true model; with 1 standard deviation, and std_lsb a quarter larger to
// allow for the motion that is lost, 1.02.
#include "gap/links/platform_link.h"

#include <array>
#include <cstddef>
#include <vector>

namespace fidservo::gap {

/// The values of h.
inline constexpr std::array<std::size_t, 7> half_widths{2, 4, 8, 16, 32, 64, 128};

/// One value for each row; rows without a reading have the value of the row before.
struct SmoothedReading {
    std::vector<double> reading_lsb;
    /// The reading by the rig file's model. Its slope jumps where the heater's command changes; the slope of
    /// reading minus model hardly does.
    std::vector<double> model_lsb;
    std::vector<double> model_bends_lsb;  ///< PlatformPrediction::bends_lsb, an equal number for each row
    std::vector<double> std_lsb;
    std::vector<double> readings;  ///< number of readings to which the row's line is fitted
    /// The (limited) macro command of the row before, V, smoothed with the same weights as the reading:
    /// crosstalk from the command into the smoothed reading is proportional to it.
    std::vector<double> drive_V;
    std::vector<double> wire_degC;  ///< by the rig file's model; empty: not known
};

/// @param model  of the reading: path_lsb and bends_lsb
/// @param command_limit_V  limit of the macro command
SmoothedReading smoothed_reading(const PlatformRun& run, const PlatformPrediction& model,
                                 double command_limit_V);

/// Standard deviation of the change, from one row to another, of the smoothed reading's error. For means over
/// m and n readings, c of them in common, with noise of sigma each: sigma sqrt(1/m + 1/n - 2c/mn).
double changed_lsb(const SmoothedReading& reading, std::size_t from, std::size_t to);

}  // namespace fidservo::gap
