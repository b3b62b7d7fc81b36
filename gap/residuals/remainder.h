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

/// The errors that an explanation leaves in the windows to which it was not fitted. They are computed once,
/// for all functions of this class.
class LeftOver {
  public:
    /// @param evidence  must outlive this object
    LeftOver(const Evidence& evidence, const CrossFit& explained);

    /// The signals with remaining errors, with the quantities on which these depend. A flexible model of each
    /// signal's errors (surrogate.h) is fitted to one half of the windows and tested on the other. Listed are
    /// signals whose errors it predicts significantly, and those with more than 1.25 floors, also if no
    /// quantity is found. A signal whose sensor probably reads falsely comes first, then the others by their
    /// errors in floors.
    /// @param tail  significance level of the test
    /// @param matters  signals with a discrepancy up to this limit are ignored
    std::vector<Remainder> remainders(double tail, const SignalLimits& matters = {}) const;

    /// The first element of remainders(); the further signals are not analysed.
    std::optional<Remainder> first_remainder(double tail, const SignalLimits& matters = {}) const;

    /// Signals that are off their floors. Tags are excepted if their errors are only a consequence of the
    /// carriage's wrong model (tags_are_innocent()).
    SignalFlags signals() const;

  private:
    std::optional<Remainder> remainder_of(const SignalGap& gap, double tail,
                                          const SignalLimits& matters) const;

    const Evidence& evidence_;
    std::vector<std::uint8_t> half_;
    Errors errors_;
    std::vector<SignalGap> gaps_;  ///< in the order of remainders()
    Pattern pattern_;
};

/// LeftOver::first_remainder() of a temporary LeftOver.
std::optional<Remainder> remainder_of(const Evidence& evidence, const CrossFit& explained, double tail,
                                      const SignalLimits& matters = {});

/// The signal with the largest error in floors, without an analysis of what its errors depend on, for when
/// there is no time for one. Empty if no signal that matters is off its floor.
std::optional<Remainder> remainder_at_sight(std::span<const SignalGap> gaps,
                                            const SignalLimits& matters = {});

}  // namespace fidservo::gap
