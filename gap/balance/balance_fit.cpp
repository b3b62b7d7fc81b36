// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/balance/balance_fit.h"

namespace fidservo::gap {

BalanceFit::BalanceFit(const ForceBalance& balance, const Wanted& wanted, const Hypothesis& base)
    : balance_(balance), wanted_(wanted), predict_([&](const Hypothesis& settings) {
          Hypothesis whole = base;
          whole.insert(whole.end(), settings.begin(), settings.end());
          return balance.excess_in_own_deviations(whole);
      }) {}

}  // namespace fidservo::gap
