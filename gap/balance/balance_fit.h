// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Effects of a carriage fitted to the balance of its forces.
#include "gap/balance/force_balance.h"
#include "gap/fit/fit.h"

#include <span>

namespace fidservo::gap {

/// Fits settings that act beside what is known, in standard deviations of their own balance. What it is made
/// of has to outlive it.
class BalanceFit {
  public:
    /// @param wanted  windows that count, as in gap/fit/score.h
    BalanceFit(const ForceBalance& balance, std::span<const Window> windows, const Wanted& wanted,
               const Hypothesis& base);

    Errors errors(const Hypothesis& settings) const { return predict_(settings); }
    Fit fit(const Hypothesis& settings) const { return gap::fit(predict_, windows_, wanted_, settings); }

  private:
    std::span<const Window> windows_;
    const Wanted& wanted_;
    Predict predict_;
};

}  // namespace fidservo::gap
