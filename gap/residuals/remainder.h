// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The errors that remain under an explanation, and the quantity on which they depend.
#include "gap/diagnosis.h"
#include "gap/search/selection.h"

#include <optional>
#include <span>

namespace fidservo::gap {

/// Fits a flexible model of each signal's remaining errors (surrogate.h) to one half of the windows and tests
/// it on the other. Empty where it predicts nothing significantly, unless more than 1.25 floors remain: then
/// the cause depends on a quantity that is not tried.
/// @param matters  signals whose discrepancy is no larger are ignored
std::optional<Remainder> remainder_of(const Evidence& evidence, const CrossFit& explained, double tail,
                                      const SignalLimits& matters = {});

/// Signals that are off their floors under an explanation, but for tags that only show how wrong the
/// carriage's model is.
SignalFlags signals_left(const Evidence& evidence, const CrossFit& explained);

/// Where there is no time to ask what errors depend on: the signal that is furthest off, in floors. Empty
/// where none is off, or none that matters.
std::optional<Remainder> remainder_at_sight(std::span<const SignalGap> gaps,
                                            const SignalLimits& matters = {});

}  // namespace fidservo::gap
