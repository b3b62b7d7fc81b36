// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The errors that remain under an explanation, and the quantity on which they depend.
#include "gap/diagnosis.h"
#include "gap/residuals/accusation.h"
#include "gap/search/selection.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace fidservo::gap {

/// What an explanation leaves in the windows to which it was not fitted, computed once for several questions.
class LeftOver {
  public:
    /// @param evidence  must outlive this object
    LeftOver(const Evidence& evidence, const CrossFit& explained);

    /// Fits a flexible model of each signal's remaining errors (surrogate.h) to one half of the windows and
    /// tests it on the other: signals of whose errors it predicts something significantly, and those with
    /// more than 1.25 floors, whose cause then depends on a quantity that is not tried. Those of which the
    /// errors say most come first.
    /// @param matters  signals whose discrepancy is no larger are ignored
    std::vector<Remainder> remainders(double tail, const SignalLimits& matters = {}) const;

    /// The first of them, without a look at the others.
    std::optional<Remainder> first_remainder(double tail, const SignalLimits& matters = {}) const;

    /// Signals that are off their floors, but for tags that only show how wrong the carriage's model is.
    SignalFlags signals() const;

  private:
    std::optional<Remainder> remainder_of(const SignalGap& gap, double tail,
                                          const SignalLimits& matters) const;

    const Evidence& evidence_;
    std::vector<std::uint8_t> half_;
    Errors errors_;
    std::vector<SignalGap> gaps_;  ///< those of which the errors say most come first
    Pattern pattern_;
};

/// LeftOver::first_remainder(), where nothing else is asked.
std::optional<Remainder> remainder_of(const Evidence& evidence, const CrossFit& explained, double tail,
                                      const SignalLimits& matters = {});

/// Where there is no time to ask what errors depend on: the signal that is furthest off, in floors. Empty
/// where none is off, or none that matters.
std::optional<Remainder> remainder_at_sight(std::span<const SignalGap> gaps,
                                            const SignalLimits& matters = {});

}  // namespace fidservo::gap
