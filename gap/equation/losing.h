// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The recordings in which an explanation loses most: what is looked for shows there.
#include "gap/evidence.h"

#include <cstddef>
#include <span>

namespace fidservo::gap {

/// A signal's windows in the fewest recordings that together hold a share of its loss, but in `least` where
/// there are so many, and in `most` at most.
/// @param mean_squares  of all windows; NaN: not judged
Wanted where_most_is_lost(const Evidence& evidence, Signal signal, std::span<const double> mean_squares,
                          double share, std::size_t least, std::size_t most);

}  // namespace fidservo::gap
