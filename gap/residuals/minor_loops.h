// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether the model of the wire's hysteresis is wrong on minor loops only.
//
// Heated from its cold end state, or cooled from its hot end state, the wire follows a branch of its major
// loop. Errors of the heater's model show there, too. Errors that appear only after a reversal between the
// end states come from the memory of the hysteresis.
#include "gap/evidence.h"

namespace fidservo::gap {

/// Whether the Hall reading's squared errors exceed their floor much more on minor loops than on either
/// branch of the major loop. False if the recordings cover too little of the minor loops or of the major
/// loop.
bool only_minor_loops_are_off(const Evidence& evidence, const Errors& errors);

}  // namespace fidservo::gap
