// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether only the hysteresis on minor loops is wrong.
//
// Heated from its cold end state, or cooled from its hot one, the wire follows the two branches of its major
// loop. Errors of heating or cooling show there as well. Errors that show only after a reversal between the
// end states are errors of the hysteresis, of its memory.
#include "gap/evidence.h"

namespace fidservo::gap {

/// Whether the Hall reading's squared errors exceed their floor much more on minor loops than on either
/// branch of the major loop. False where the recordings have too little of one of them.
bool only_minor_loops_are_off(const Evidence& evidence, const Errors& errors);

}  // namespace fidservo::gap
