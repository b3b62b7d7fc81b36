// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The errors that remain under an explanation, and the quantity on which they depend.
#include "gap/diagnosis.h"
#include "gap/search/selection.h"

#include <optional>

namespace fidservo::gap {

/// Fits a flexible model of each signal's remaining errors (surrogate.h) to one half of the windows and tests
/// it on the other. Empty where it predicts nothing significantly, unless more than 1.25 floors remain: then
/// the cause depends on a quantity that is not tried.
/// @param matters  signals whose discrepancy is no larger are ignored
std::optional<Remainder> remainder_of(const Evidence& evidence, const CrossFit& explained, double tail,
                                      const SignalLimits& matters = {});

}  // namespace fidservo::gap
