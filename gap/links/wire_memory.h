// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is known of the memory of a wire that is warm when its recording begins.
//
// The wire is a sum of relays, each of which switches up when the temperature rises above its upper
// threshold, and down when it falls below its lower one (Mayergoyz, Mathematical Models of Hysteresis, 1991,
// ch. 1). Once the temperature has reached a highest value M and a lowest value m, the states of all relays
// are known except those of relays with the upper threshold above M and the lower one below m. They are still
// in the states from before the recording and contribute to the contraction at most
//
//     w = f(high, m) - f(M, m)     mm, f: the table of first-order descending curves, high: its upper end
//
// As long as the temperature stays between m and M none of them switches, and the contraction is known up to
// a constant of at most w, whatever happened before (congruency, ibid.). If w is negligible, the memory is
// known.
#include "gap/links/platform_link.h"

namespace fidservo::gap {

/// If a run's wire is warm at its start, keeps only the windows in which no relay in an unknown state
/// switches, and marks those in which the platform is offset by an unknown constant. Temperatures count for M
/// and m only once the influence of the unknown first temperature has decayed. Other runs are not changed.
/// @param nominal  the rig file's stage
void keep_known_memory(PlatformRun& run, const PlatformModel& nominal);

}  // namespace fidservo::gap
