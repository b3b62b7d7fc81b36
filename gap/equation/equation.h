// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An equation for what no named effect explains: a formula at a port of the machine, found in the recordings.
//
// For every port of the stage that is accused, terms are screened (gap/equation/screening.h); what they come
// to is written as a formula effect, and its coefficients and shapes are fitted in the simulator together on
// each half of the windows, and judged on the other. Of the ports' formulas the best is kept, then shortened
// as long as it is as good.
#include "gap/diagnosis.h"
#include "gap/equation/equation_search.h"
#include "gap/fit/cross_fit.h"

#include <optional>
#include <span>

namespace fidservo::gap {

/// An equation with the cross fit of which it is the last setting.
struct ProposedEquation {
    Equation equation;
    CrossFit fitted;
    Fit of_all;  ///< names and equation together, fitted to all windows
};

/// @param base  the explanation beside which it is looked for
/// @param before  mean squares of the windows without it, beside which its gap_removed is told
/// @param number  of the effect's name, unnamed_1
/// @param tail  of proposing anything where there is nothing, over the whole search
/// @param rival  another explanation of the same: formulas that promise less are given up
/// @return none where no formula predicts better beyond chance and removes some of the gap for sure (95 %).
/// Throws BudgetEnded where nothing was found by then.
std::optional<ProposedEquation> equation_of(const Evidence& evidence, const CrossFit& base,
                                            const Remainder& remainder, int number, double tail,
                                            const std::optional<Rival>& rival = {});

}  // namespace fidservo::gap
