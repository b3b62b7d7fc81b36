// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How an explanation grows, effect by effect.
#include "gap/search/chain.h"

#include <vector>

namespace fidservo::gap {

struct Growth {
    std::size_t most_effects;  ///< the largest number of effects of the chain
    /// Whether to scan for a weak force wave along the rail (Search::scan_for_wave) if the first effect on
    /// the carriage leaves the encoder far off its floor.
    bool scans = true;
    /// How many of the most promising candidates each step fits.
    std::size_t fits = Effort{}.fits;
};

/// Accepts the best effect beside the chain, one after the other, as long as its gain is real
/// (Search::is_real). While the encoder stays far off its floor, a weak force wave along the rail is scanned
/// for, and a wave or a spring is fitted again from many randomly drawn start values before further effects
/// are looked for.
/// @param first_step  receives the trials of the first step; may be null
/// @return whether a wave and another effect were accepted in place of a single effect
bool grow(Search& search, Chain& chain, const Growth& growth, std::vector<Trial>* first_step);

}  // namespace fidservo::gap
