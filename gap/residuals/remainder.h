// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an explanation leaves, and what that depends on.
#include "gap/diagnosis.h"
#include "gap/search/selection.h"

#include <optional>

namespace fidservo::gap {

/// A flexible model of what is left of each signal (surrogate.h), fitted on one half of the windows and
/// judged on the other. Empty where it predicts
/// nothing beyond chance, unless what is left is more than 1.25 floors: a gap whose cause depends on
/// something else.
/// @param matters  signals whose discrepancy is no larger are passed over
std::optional<Remainder> remainder_of(const Evidence& evidence, const CrossFit& explained, double tail,
                                      const SignalLimits& matters = {});

}  // namespace fidservo::gap
