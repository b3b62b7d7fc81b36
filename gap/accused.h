// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which blocks of the rig file a diagnosis accuses of being wrong, and whether the effects that it names are
// credible.
#include "gap/diagnosis.h"

#include <string>
#include <vector>

namespace fidservo::gap {

/// Adds evidence against a block: its probability p becomes 1 - (1 - p)(1 - probability). The list is sorted
/// by probability, the most likely first; blocks whose probabilities differ by less than 0.05 are in the
/// order in which they were accused.
void accuse(std::vector<BlockProbability>& where, const std::string& block, double probability);

/// The mean probability of the effects named; 0 without effects.
double mean_probability(const std::vector<FoundEffect>& effects);

/// Whether the mean probability of the effects named is above a half. If it is not, they may only imitate
/// another cause.
bool are_credible(const std::vector<FoundEffect>& effects);

}  // namespace fidservo::gap
