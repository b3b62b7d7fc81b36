// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is found of many causes at once, before any is looked for one by one.
#include "gap/search/chain.h"

#include <optional>
#include <vector>

namespace fidservo::gap {

struct AtOnce {
    bool is_balanced;  ///< what balances the carriage's forces brings the encoder to its floor and stands
    bool are_several;  ///< more than one effect was taken in at a time
};

/// Explains view and wire by all that is smooth, the carriage by what balances its forces, and what is left
/// of Hall reading and tags by effects with a shape of their own; each of them by one effect where that does
/// as well.
/// @param aside  the whole with what balances the forces, where that leaves the encoder off its floor: the
///               chain then knows nothing of how the carriage moves, so that a search for it may begin anew
/// @param alone  what was tried alone; what is tried here is added
AtOnce explain_at_once(Search& search, Chain& chain, std::optional<Chain>& aside, std::vector<Trial>& alone);

/// A chain with what another one has of the carriage and its encoder instead of its own.
Chain with_carriage_of(const Search& search, const Chain& chain, const Chain& other);

/// Adds what was tried later for signals of which nothing was tried before; best first.
void add_tried(std::vector<Trial>& alone, std::vector<Trial> later);

}  // namespace fidservo::gap
