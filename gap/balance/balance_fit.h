// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Effects of a carriage fitted to the balance of its forces.
#include "gap/balance/force_balance.h"
#include "gap/fit/fit.h"
#include "gap/numbers.h"

namespace fidservo::gap {

/// How many of several waves, or forms of a model, are fitted.
inline constexpr std::size_t most_fitted_forms = beam;

/// Fits settings of effects, in addition to a base hypothesis, to the balance of forces. A residual is a
/// support's excess force (gap/balance/force_balance.h) in units of ForceBalance::deviations standard
/// deviations, which are computed for the settings that are tried. The constructor's arguments must outlive
/// the object.
class BalanceFit {
  public:
    /// @param wanted  the windows to be used, as in gap/fit/score.h
    BalanceFit(const ForceBalance& balance, const Wanted& wanted, const Hypothesis& base);

    Errors errors(const Hypothesis& settings) const { return predict_(settings); }
    Fit fit(const Hypothesis& settings) const {
        return gap::fit(predict_, balance_.windows(), wanted_, settings);
    }

  private:
    const ForceBalance& balance_;
    const Wanted& wanted_;
    Predict predict_;
};

}  // namespace fidservo::gap
