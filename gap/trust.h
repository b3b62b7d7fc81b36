#pragma once
// How far the names of an explanation are to be trusted (docs/diagnosis.md).
#include "gap/diagnosis.h"
#include "gap/remainder.h"
#include "gap/selection.h"

#include <optional>

namespace fidservo::gap {

struct Trust {
    double in_names;                   ///< 0 .. 1; 0 where there are none and something is missing
    std::optional<Remainder> missing;  ///< what is left, or what the names stand in for
};

/// By what an explanation leaves, how much of the gap it removes, and whether the gap as a whole shows what
/// none of the names has.
/// @param tail  of finding that something depends on anything where it does not
Trust trust_of(const Evidence& evidence, const Selection& selection, const TotalGap& gap, double tail);

}  // namespace fidservo::gap
