// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Windows in which the carriage's motion cannot be predicted.
#include "gap/fit/cross_fit.h"

#include <vector>

namespace fidservo::gap {

/// A flag for each window. An encoder window is unpredictable if its error is above the floor but not much
/// larger than the change of its prediction (by the fit to the other half) when the window's initial position
/// is varied within a count. Counts do not determine that position, and with a periodic force it may decide
/// in which direction the carriage moves. Windows of tags that overlap with such a window are unpredictable,
/// too.
std::vector<bool> unpredictable_windows(const Evidence& evidence, const CrossFit& fitted);

}  // namespace fidservo::gap
