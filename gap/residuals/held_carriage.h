// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether something holds a carriage that the drive should move.
//
// Friction at rest does not show in the forces that a sliding carriage lacks (gap/balance/carriage_forces.h).
// It shows where the carriage stands although its command is clearly beyond the dead zone's edge; near the
// edge any small force can hold it.
#include "gap/evidence.h"

namespace fidservo::gap {

/// Whether the carriage stands in this way, away from the ends of the rail, for longer than its inertia and a
/// play of a millimetre explain: at least twice, and while the rig file's drive would have moved it by 5 mm
/// in total, the first time constant not counted.
bool carriage_is_held(const Evidence& evidence);

}  // namespace fidservo::gap
