// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/images/image_frame.h"
#include "src/images/image_names.h"

#include <string>
#include <vector>

namespace fidservo {

/// Sets the times and the order of a series' frames by their names. Returns one line on what was decided, or
/// nothing if names do not look like times. Frames get no times where only some names are times, two are the
/// same one, or the unit could be ms or us. Throws InputError where `unit` says that names are times and one
/// is not, or two are the same.
/// @param whose  what the line calls the series
std::string take_times_of_names(const std::string& whose, NameTimes unit, std::vector<ImageFrame>& frames);

}  // namespace fidservo
