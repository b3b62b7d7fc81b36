// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Explanations by several effects fitted at once, made before effects are looked for one by one.
#include "gap/search/chain.h"

#include <optional>
#include <vector>

namespace fidservo::gap {

struct AtOnce {
    bool is_balanced;  ///< the model from the balance of forces brings the encoder to its floor and is kept
    bool are_several;  ///< more than one effect was accepted in one step
};

/// Explains Hall reading and tags by all smooth effects at once, the encoder by a model from the balance of
/// the carriage's forces, and what is left of Hall reading and tags by effects with a shape of their own;
/// each of these by a single effect where that does as well.
/// @param aside  receives the whole chain if that model leaves the encoder off its floor; the chain itself
/// then loses its effects on the carriage's motion, so that the search for these can begin afresh
/// @param alone  trials of single effects; those made here are added
AtOnce explain_at_once(Search& search, Chain& chain, std::optional<Chain>& aside, std::vector<Trial>& alone);

/// A chain whose effects on the carriage's motion or its encoder are replaced by those of another chain.
Chain with_carriage_of(const Search& search, const Chain& chain, const Chain& other);

/// Adds later trials: of candidates that were not tried before, or with a larger gain. Sorts all, best first.
void add_tried(std::vector<Trial>& alone, std::vector<Trial> later);

}  // namespace fidservo::gap
