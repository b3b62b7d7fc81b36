// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether only the hysteresis between the wire's end states is off.
//
// Heated from its cold end state, or cooled from its hot one, the wire follows the two branches of its major
// loop. Whatever heats or cools it wrongly shows there as well. What shows only after a turn between the end
// states is the hysteresis: how it remembers.
#include "gap/evidence.h"

namespace fidservo::gap {

/// Whether the squares of the Hall reading's errors exceed their floor by far more on minor loops than on
/// either branch of the major loop. False where the recordings have too little of one of them.
bool only_minor_loops_are_off(const Evidence& evidence, const Errors& errors);

}  // namespace fidservo::gap
