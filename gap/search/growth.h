// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How an explanation grows, effect by effect.
#include "gap/search/chain.h"

#include <vector>

namespace fidservo::gap {

struct Growth {
    std::size_t most_effects;  ///< the largest number of effects of the chain
    /// Whether a weak wave is scanned for where the first effect on the carriage leaves the encoder far off.
    bool scans = true;
    /// How many of the most promising candidates each step fits.
    std::size_t fits = Effort{}.fits;
};

/// Accepts the best effect beside the chain, one after the other, as long as its gain is real
/// (Search::is_real). Where the encoder stays far off, a weak wave is scanned for; and a wave or a spring
/// that leaves much is fitted again from many drawn values before further effects are looked for.
/// @param first_step  receives the trials of the first step; may be null
/// @return whether a wave and another effect have replaced a single effect
bool grow(Search& search, Chain& chain, const Growth& growth, std::vector<Trial>* first_step);

}  // namespace fidservo::gap
