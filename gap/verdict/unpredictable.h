// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Windows in which the carriage's motion cannot be predicted.
#include "gap/fit/cross_fit.h"

#include <vector>

namespace fidservo::gap {

/// For each window of the encoder, whether its error above the floor is no larger than the change of its
/// prediction (by the fit to the other half) with the window's initial position within a count. Counts do not
/// show that position, and over a periodic force it may decide into which direction the carriage goes. The
/// tags that are seen meanwhile are unpredictable, too.
std::vector<bool> unpredictable_windows(const Evidence& evidence, const CrossFit& fitted);

}  // namespace fidservo::gap
