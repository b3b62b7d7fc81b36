// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Ticks that a control loop left out because it was late.
#include "core/recording.h"

#include <cstddef>
#include <vector>

namespace fidservo::gap {

struct LateTicks {
    std::vector<bool> is_filled;  ///< whether a row was inserted here
    std::size_t left_out = 0;     ///< number of ticks without a row; pauses of more than 0.1 s do not count
};

/// Inserts rows where one or two ticks are missing. They have the commands and setpoints of the row before,
/// which stayed in force, and readings interpolated linearly, rounded where the sensor's are whole numbers.
/// At an acceleration a and a tick T the interpolation is off by a T^2 / 2 for one missing tick and by a T^2
/// for two. Longer pauses are not filled, since what the sensors would have shown is not known.
LateTicks fill_late_ticks(Recording& recording);

}  // namespace fidservo::gap
