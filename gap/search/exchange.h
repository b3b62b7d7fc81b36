// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The test of each effect of an explanation.
#include "gap/search/chain.h"

namespace fidservo::gap {

/// Tests each effect of a chain, since an effect that was accepted early may be a compromise between two
/// others. It is removed if the remaining effects explain as well without it, and otherwise replaced by the
/// effect that explains best beside them. The last effect of an unchanged chain is not tested: it was
/// selected beside exactly these others.
/// @param changed  whether the chain was changed before
/// @return whether it was changed before or here
bool exchange(Search& search, Chain& chain, bool changed);

/// Removes effects that are not needed for an explanation without a gap: after refitting the others, all
/// signals that the removed effect changes are still at their floors. Only the few effects that matter least
/// are tested.
Chain without_needless(const Search& search, const Evidence& evidence, Chain chain);

/// A chain without those effects without which the rest, fitted again, predicts at least as well: they were
/// added where the rest had not come to its optimum, and keep it from there. Says of each effect that stays
/// what is left out without it (Choice::left_out). In a long chain the rest is not fitted again.
Chain without_hindrances(const Search& search, Chain chain);

}  // namespace fidservo::gap
