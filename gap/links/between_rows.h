// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Values at times between two rows, as a camera needs them whose frames come at any time.
#include "gap/links/carriage_path.h"
#include "gap/links/hall_smoothing.h"

#include <cstddef>
#include <vector>

namespace fidservo::gap {

/// A time between two rows.
struct Moment {
    std::size_t row;
    double share;  ///< of the time to the next row
    bool is_tick;  ///< whether the next row is one tick away
};

/// Times before the first row count as that row's, times after the last one as that one's.
/// @param time_s  of each row
Moment moment_at(const std::vector<double>& time_s, double tick_s, double at_s);

std::size_t nearest_row(const std::vector<double>& time_s, double tick_s, double at_s);

/// Cubic interpolation by the path's positions and velocities (Hermite); linear where rows are missing.
double carriage_mm(const CarriagePath& path, const Moment& at, double tick_s);

/// Cubic interpolation by four neighbours (Catmull and Rom).
double between(const std::vector<double>& values, const Moment& at);

/// The Hall reading: the model's as it moves within a tick, and what differs from it by cubic interpolation.
/// The heater's command makes the model's rate jump at a tick, the corners of the wire's table within one.
double reading_lsb(const SmoothedReading& reading, const Moment& at);

}  // namespace fidservo::gap
