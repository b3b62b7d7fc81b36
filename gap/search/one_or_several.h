// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An explanation of a signal by several effects that were found at once, or by a single one that does as
// well.
#include "gap/search/chain.h"

#include <cstddef>
#include <vector>

namespace fidservo::gap {

/// Explanations of a signal by more effects than this, found at once, are accepted without a search.
inline constexpr std::size_t most_one_by_one = 2;

/// Whether a chain leaves a signal off its floor.
bool is_off(const Search& search, const Chain& chain, Signal signal);

/// A chain with the cross fit of `together`, whose candidates are appended as choices.
Chain with_together(Chain chain, Search::Together together);

/// Explains a signal that is off its floor by one effect, or by those that `whole` found at once if these do
/// better. More than two such effects, or such as make the chain long, are not compared with a single one. A
/// smooth effect that both ways find, and that brings the signal to its floor, is not fitted more closely.
/// @param alone  trials of single effects; those made here are added
/// @return whether the effects of `whole` were accepted
bool explain_by_one_or(Search& search, Chain& chain, Chain whole, Signal signal, std::vector<Trial>& alone);

/// Adds later trials: of candidates that were not tried before, or with a larger gain. Sorts all, best first.
void add_tried(std::vector<Trial>& alone, std::vector<Trial> later);

}  // namespace fidservo::gap
