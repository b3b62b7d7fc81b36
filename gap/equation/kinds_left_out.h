// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether an equation holds for experiments of a kind that it was not fitted to.
#include "gap/fit/cross_fit.h"

#include <vector>

namespace fidservo::gap {

/// Mean squares of the windows where those of each kind of experiment are predicted by a hypothesis whose
/// last setting was fitted to the other kinds alone. Empty where all recordings are of one kind.
/// @param cross  with the setting last; where a fit begins
std::vector<double> predicted_from_other_kinds(const Evidence& evidence, const CrossFit& cross);

}  // namespace fidservo::gap
