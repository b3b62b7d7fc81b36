#pragma once
// How an explanation grows, effect by effect, or by two at once where one leads nowhere.
#include "gap/chain.h"

#include <optional>
#include <vector>

namespace fidservo::gap {

struct Growth {
    std::size_t most_effects;  ///< that the chain may have
    bool in_pairs = true;      ///< whether two may be taken in at once
};

/// Puts two effects at once beside the rest, where they clear a share of a signal, or one of them alone,
/// fitted beside the other. Returns whether both are in.
/// @param is_needed  whether it is known otherwise that it takes both: any gain will do that is no chance, as
///                   a few windows that go another way may be all that is left
bool take_in_pair(Search& search, Chain& chain, const Chain& rest, std::optional<Pair> pair, double share,
                  bool is_needed);

/// Where a carriage stays off, what balances its forces best instead of what was taken in for it.
/// @param only_needed  two that the balance needs both
/// @return whether anything changed
bool balance(Search& search, Chain& chain, std::size_t most_effects, bool only_needed);

/// Takes in what is best, as long as it is no chance; for a carriage or a wire that one effect leaves off,
/// two at once. A weak wave is scanned for where the carriage stays far off; a wave or a spring that leaves
/// much is looked for among many values before anything is looked for beside it.
/// @return whether a pair took the place of something
bool grow(Search& search, Chain& chain, const Growth& growth, std::vector<Trial>* first_step);

}  // namespace fidservo::gap
