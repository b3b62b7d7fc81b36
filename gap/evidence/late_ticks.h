// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Ticks that a loop left out because it was late.
#include "core/recording.h"

#include <cstddef>
#include <vector>

namespace fidservo::gap {

struct LateTicks {
    std::vector<bool> is_filled;  ///< which rows of the recording are not of its file
    std::size_t left_out = 0;     ///< of its ticks; pauses of more than 0.1 s do not count
};

/// Puts rows where one tick or two are left out: commands and setpoints of the row before, which went on
/// meanwhile, and readings on the line between those on either side, in whole numbers where the sensor's are.
/// At an acceleration a the line is off by a T^2 / 8 over one tick of T left out, by a T^2 over two. Longer
/// pauses stay: what the sensors would have shown is not known.
LateTicks fill_late_ticks(Recording& recording);

}  // namespace fidservo::gap
