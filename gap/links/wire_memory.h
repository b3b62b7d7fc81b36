// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is known of the memory of a wire that is warm when its recording begins.
//
// The wire is a sum of relays, each of which goes up when the temperature passes its upper threshold and down
// when it passes its lower one (Mayergoyz, Mathematical Models of Hysteresis, 1991, ch. 1). Once the
// temperature has been at M and at m, all relays are known but those whose thresholds lie above M and below
// m: these have kept what they were before the recording began. They are worth
//
//     w = f(high, m) - f(M, m)     mm, f: the table of first-order descending curves, high: its upper end
//
// As long as the temperature stays between m and M none of them switches, and the contraction is known up to
// a constant of at most w, whatever went before (congruency, ibid.). Where w is next to nothing the memory is
// known.
#include "gap/links/platform_link.h"

namespace fidservo::gap {

/// Of a run whose wire is warm at its start, keeps the windows in which no relay switches of which nothing is
/// known, and marks those that are beside their prediction by a constant. The temperature counts from when
/// what it was at the start is forgotten. A run whose wire remembers nothing at its start stays as it is.
/// @param nominal  the rig file's stage
void keep_known_memory(PlatformRun& run, const PlatformModel& nominal);

}  // namespace fidservo::gap
