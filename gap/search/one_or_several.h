// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The choice between explaining a signal by several effects that were found at once and by a single one.
#include "gap/search/chain.h"

#include <cstddef>
#include <vector>

namespace fidservo::gap {

/// If more effects than this were found at once, they are accepted without a search for single effects.
inline constexpr std::size_t most_one_by_one = 2;

/// Whether a chain leaves a signal off its floor.
bool is_off(const Search& search, const Chain& chain, Signal signal);

/// A chain with the cross fit of `together`, whose candidates are appended as choices.
Chain with_together(Chain chain, Search::Together together);

/// Explains a signal that is off its floor by one effect, or by those that `whole` found at once if these do
/// better. More than most_one_by_one such effects, or effects that make the chain long (is_long()), are not
/// compared with a single one. If `whole` adds only one smooth effect, the trials rank the same effect first,
/// and it brings the signal to its floor, then the fit in `whole` is kept.
/// @param alone  trials of single effects; those made here are added
/// @return whether the effects of `whole` were accepted
bool explain_by_one_or(Search& search, Chain& chain, Chain whole, Signal signal, std::vector<Trial>& alone);

/// Merges later trials into `alone`: for each candidate the trial with the largest gain is kept. Sorts all
/// trials by gain, largest first.
void add_tried(std::vector<Trial>& alone, std::vector<Trial> later);

}  // namespace fidservo::gap
