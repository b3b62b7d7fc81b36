// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Interpolation of a recording's values at times between its rows, at which camera frames are taken.
#include "gap/links/carriage_path.h"
#include "gap/links/hall_smoothing.h"

#include <cstddef>
#include <vector>

namespace fidservo::gap {

/// A time between two rows.
struct Moment {
    std::size_t row;
    double share;  ///< time since `row`, as a fraction of the time from it to the next row
    bool is_tick;  ///< whether the next row is one tick away
};

/// The moment of a time; times outside of the recording count as its first or last row's.
/// @param time_s  of each row, on the same clock as `at_s`
Moment moment_at(const std::vector<double>& time_s, double tick_s, double at_s);

std::size_t nearest_row(const std::vector<double>& time_s, double tick_s, double at_s);

/// The carriage's position: cubic Hermite interpolation of the path's positions and velocities; linear over
/// missing rows.
double carriage_mm(const CarriagePath& path, const Moment& at, double tick_s);

/// Cubic interpolation of the four neighbouring values (Catmull and Rom).
double between(const std::vector<double>& values, const Moment& at);

/// The Hall reading: the rig file's model as simulated within the tick, plus the cubic interpolation of the
/// difference between reading and model. Interpolating the reading itself would be wrong, since its slope
/// jumps at ticks, where the heater's command changes, and within a tick, at the kinks of the wire's table.
double reading_lsb(const SmoothedReading& reading, const Moment& at);

}  // namespace fidservo::gap
