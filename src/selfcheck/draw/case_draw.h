// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The cases of a self-check: what each is made with, drawn at random and evenly.
#include "src/selfcheck/draw/label.h"
#include "src/selfcheck/draw/true_rig.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fidservo::selfcheck {

struct Case {
    std::size_t number = 0;
    Label label;
    TrueRig true_rig;
    std::vector<std::string> without;  ///< effects that the diagnosis is not given
    std::uint64_t campaign_seed = 0;   ///< of excitation and noise
};

/// The kind of a case. Of ten cases in a row two have no effect, four have one, two have two, in one effect
/// is withheld and in one the catalogue lacks it; their order is drawn.
CaseKind kind_of_case(std::uint64_t seed, std::size_t number);

/// A case is a pure function of seed and number. All classes of effects are met once, in an order drawn,
/// before one is met again; so among cases with one effect, among those with two, and among those withheld.
/// Sizes are drawn evenly in the logarithm, from below the floor, or a 300th of the largest where that is
/// more, to the largest.
/// @param nominal  the rig as its file describes it; with a micro stage, a camera and controllers
Case draw_case(const Rig& nominal, std::uint64_t seed, std::size_t number);

}  // namespace fidservo::selfcheck
