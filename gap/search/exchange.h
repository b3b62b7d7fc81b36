// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The test of each effect of an explanation.
#include "gap/search/chain.h"

namespace fidservo::gap {

/// Tests each effect, since one that was accepted first may be a compromise of two others: it is given up if
/// the rest does as well without it, and otherwise exchanged for what is best beside the rest. As long as
/// nothing has changed, the last effect needs no test: it was found beside this very rest.
/// @param changed  whether the chain was changed before
/// @return whether it was changed before or here
bool exchange(Search& search, Chain& chain, bool changed);

/// A chain without those effects without which, once the rest is fitted again, no gap is left in the signals
/// that they change: a shorter explanation does as well. The few that matter least are tested.
Chain without_needless(const Search& search, const Evidence& evidence, Chain chain);

/// A chain without those effects without which the rest, fitted again, predicts at least as well: they were
/// added where the rest had not come to its optimum, and keep it from there. Says of each effect that stays
/// what is left out without it (Choice::left_out). In a long chain the rest is not fitted again.
Chain without_hindrances(const Search& search, Chain chain);

}  // namespace fidservo::gap
