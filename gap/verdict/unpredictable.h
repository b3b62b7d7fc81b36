// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Windows in which nobody can say where the carriage goes.
#include "gap/fit/cross_fit.h"

#include <vector>

namespace fidservo::gap {

/// Whether the error of a window of the encoder, above its floor, is as small as what its prediction, by what
/// was fitted on the other half, changes by where in a count the window begins. Counts do not tell that; over
/// a force along the rail that alone may decide which way the carriage goes. So are the tags seen meanwhile.
std::vector<bool> unpredictable_windows(const Evidence& evidence, const CrossFit& fitted);

}  // namespace fidservo::gap
