// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How an explanation grows, effect by effect.
#include "gap/search/chain.h"

#include <vector>

namespace fidservo::gap {

struct Growth {
    std::size_t most_effects;  ///< that the chain may have
    bool scans = true;         ///< for a weak wave, where the first effect of a carriage leaves it far off
};

/// Takes in what is best, as long as it is no chance. A weak wave is scanned for where the carriage stays far
/// off; a wave or a spring that leaves much is looked for among many values before anything is looked for
/// beside it.
/// @return whether a wave and another effect took the place of one
bool grow(Search& search, Chain& chain, const Growth& growth, std::vector<Trial>* first_step);

}  // namespace fidservo::gap
