// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Draws the cases of a self-check at random but evenly over kinds and effects.
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
    std::vector<std::string> without;  ///< effects that the diagnosis may not use
    std::uint64_t campaign_seed = 0;   ///< seed of excitation and noise
};

/// The kind of a case. Of ten cases in a row two have no effect, four have one, two have two, in one the
/// effect is withheld from the diagnosis, and in one the catalogue lacks it; their order is random.
CaseKind kind_of_case(std::uint64_t seed, std::size_t number);

/// A case is a pure function of seed and number. All classes of effects occur once, in random order, before
/// one occurs again; this holds separately for cases with one effect, with two, and with a withheld one. The
/// logarithm of a size is uniformly distributed (draw/put_effect.h).
/// @param nominal  the rig as its file describes it; with a micro stage, a camera and controllers
Case draw_case(const Rig& nominal, std::uint64_t seed, std::size_t number);

}  // namespace fidservo::selfcheck
