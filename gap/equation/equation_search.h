// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The search for an equation: terms of the ports of a stage, fitted in the simulator on one half of the
// windows and tested on the other.
#include "gap/equation/sketch.h"
#include "gap/fit/cross_fit.h"

#include <optional>
#include <string>
#include <string_view>

namespace fidservo::gap {

/// A sketch after its fit in the simulator.
struct FittedSketch {
    Sketch sketch;
    const plant::Effect* effect;
    CrossFit fitted;  ///< cross fit; the effect is its last setting
};

/// Another explanation of what a base leaves unexplained; a formula has to be more promising.
struct Rival {
    const CrossFit& explanation;
    bool is_credible;  ///< if it is, only ports of the block that is probably wrong are tried against it
};

/// The formula that predicts best when added to an explanation, extended and shortened; empty where no
/// formula of the stage's ports predicts significantly better.
/// @param base  the explanation to which it is added
/// @param block  the block that is probably wrong: its ports come first, and others only if these do not
/// explain everything
/// @param signal  in which the block was seen to be wrong. Where tags alone say so of a reading, what
/// displaces them on the plate as that would is tried, too
/// @param name  name of the formula effect
/// @param tail  probability of proposing anything where there is nothing, over the whole search
/// @param rival  a formula that predicts held-out data worse than it is dropped; if it is credible, also one
/// that predicts no better than rival and formula together
/// Throws BudgetEnded if the budget ends before anything was found.
std::optional<FittedSketch> search_equation(const Evidence& evidence, const CrossFit& base,
                                            std::string_view block, std::optional<Signal> signal,
                                            const std::string& name, double tail,
                                            const std::optional<Rival>& rival = {});

}  // namespace fidservo::gap
