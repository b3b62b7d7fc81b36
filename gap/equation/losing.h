// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The recordings in which an explanation's loss is largest, where missing effects show best.
#include "gap/evidence.h"

#include <cstddef>
#include <span>

namespace fidservo::gap {

/// The windows of a signal in the smallest number of recordings that together hold a fraction `share` of its
/// loss, but in at least `least` (if there are so many) and at most `most` recordings.
/// @param mean_squares  of all windows; NaN: not judged
Wanted where_most_is_lost(const Evidence& evidence, Signal signal, std::span<const double> mean_squares,
                          double share, std::size_t least, std::size_t most);

}  // namespace fidservo::gap
