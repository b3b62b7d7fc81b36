// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The search for an equation: terms of the ports of a stage, fitted in the simulator and judged on the other
// half of the windows.
#include "gap/equation/sketch.h"
#include "gap/fit/cross_fit.h"

#include <optional>
#include <string>
#include <string_view>

namespace fidservo::gap {

/// A sketch in the simulator.
struct FittedSketch {
    Sketch sketch;
    const plant::Effect* effect;
    CrossFit fitted;  ///< the effect last
};

/// Another explanation of what a base leaves, than which a formula has to promise more.
struct Rival {
    const CrossFit& explanation;
    bool is_credible;  ///< then only the accused block's own ports are tried against it
};

/// The formula that predicts best beside an explanation, grown and shortened; none where no formula of the
/// stage's ports predicts better beyond chance.
/// @param base  beside which it is looked for
/// @param block  that is accused: its ports come first, and the others only where these leave something
/// @param name  of the effect
/// @param tail  of proposing anything where there is nothing, over the whole search
/// @param rival  a formula that predicts what it was not fitted to worse than it is given up; if it is
/// credible,
///               also one that predicts no better than rival and formula together
/// Throws BudgetEnded where nothing was found by then.
std::optional<FittedSketch> search_equation(const Evidence& evidence, const CrossFit& base,
                                            std::string_view block, const std::string& name, double tail,
                                            const std::optional<Rival>& rival = {});

}  // namespace fidservo::gap
