// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which blocks a diagnosis accuses, and how much its names are to be believed.
#include "gap/diagnosis.h"

#include <string>
#include <vector>

namespace fidservo::gap {

/// Accuses a block, beside what accuses it already: 1 - (1 - p)(1 - probability). Likeliest first; of those
/// that are as likely to a twentieth, what was accused first.
void accuse(std::vector<BlockProbability>& where, const std::string& block, double probability);

/// Of the effects named; 0 where none is.
double mean_probability(const std::vector<FoundEffect>& effects);

/// Whether their mean probability is above a half: names that are not may stand in for something else.
bool are_credible(const std::vector<FoundEffect>& effects);

}  // namespace fidservo::gap
