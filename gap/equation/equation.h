// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An equation for what no named effect explains: a formula at a port of the machine, found in the recordings.
//
// For every port of the stage in which the remaining gap probably originates, terms are screened
// (gap/equation/screening.h). The selected terms are written as a formula effect, whose coefficients and
// shapes are fitted together in the simulator on each half of the windows, and tested on the other half. The
// best of the ports' formulas is kept, and shortened as long as it remains as good.
#include "gap/diagnosis.h"
#include "gap/equation/equation_search.h"
#include "gap/fit/cross_fit.h"

#include <optional>
#include <span>

namespace fidservo::gap {

/// An equation, and the cross fit of which it is the last setting.
struct ProposedEquation {
    Equation equation;
    CrossFit fitted;
    Fit of_all;  ///< named effects and equation fitted together to all windows
};

/// Searches for an equation.
/// @param base  the explanation to which it is added
/// @param remainder  what the base leaves unexplained, and the block in which it probably originates
/// @param number  number in the effect's name, as in unnamed_1
/// @param tail  probability of proposing anything where there is nothing, over the whole search
/// @param rival  another explanation of the same gap: less promising formulas are dropped
/// @return empty where no formula predicts significantly better and certainly (95 %) removes some of the gap.
/// Throws BudgetEnded if the budget ends before anything was found.
std::optional<ProposedEquation> equation_of(const Evidence& evidence, const CrossFit& base,
                                            const Remainder& remainder, int number, double tail,
                                            const std::optional<Rival>& rival = {});

}  // namespace fidservo::gap
