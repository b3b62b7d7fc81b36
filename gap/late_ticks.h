#pragma once
// Ticks that a loop left out because it was late.
#include "core/recording.h"

#include <vector>

namespace fidservo::gap {

/// Puts rows where one tick or two are left out: commands and setpoints of the row before, which went on
/// meanwhile, and readings on the line between those on either side, in whole numbers where the sensor's are.
/// At an acceleration a the line is off by a T^2 / 8 over one tick of T left out, by a T^2 over two. Longer
/// pauses stay: what the sensors would have shown is not known.
/// @return which rows of the recording are not of its file
std::vector<bool> fill_late_ticks(Recording& recording);

}  // namespace fidservo::gap
