// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether an equation holds for a kind of experiment to which it was not fitted.
#include "gap/fit/cross_fit.h"

#include <vector>

namespace fidservo::gap {

/// Mean squares of the windows, where the windows of each kind of experiment are predicted by a hypothesis
/// whose last setting was fitted to the other kinds only. Empty where all recordings are of one kind.
/// @param cross  has that setting last, and gives the start values of the fits
std::vector<double> predicted_from_other_kinds(const Evidence& evidence, const CrossFit& cross);

}  // namespace fidservo::gap
