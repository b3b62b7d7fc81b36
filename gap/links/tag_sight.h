// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A detection of a tag with the stages' motion at that time.
#include "gap/evidence.h"
#include "gap/links/tag_link.h"

#include <cstddef>

namespace fidservo::gap {

struct TagSight {
    std::size_t run;
    const TagSighting& tag;
    double position_mm;        ///< of the carriage
    double velocity_mm_per_s;  ///< of carriage and platform together
    double contraction_mm, time_s;
    bool has_stood;  ///< whether both stages have stood still for the last 100 ms
};

/// The motion is taken from the readings.
/// @param detection  index in the recording, as in Window::first_detection
TagSight sight_of(const Evidence& evidence, std::size_t run, std::size_t detection);

}  // namespace fidservo::gap
