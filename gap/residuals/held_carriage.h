// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether something holds a carriage that the drive would move.
//
// Friction at rest shows in no force that a sliding carriage lacks (gap/balance/carriage_forces.h). It shows
// where the carriage stands although its command is clearly beyond the dead zone's edge: at the edge itself
// any small force keeps it there.
#include "gap/evidence.h"

namespace fidservo::gap {

/// Whether it stands like that, away from the ends of the rail, for longer than its inertia and play of a
/// millimetre explain: twice or more, and by 5 mm in all that the rig file's drive would have moved it on by
/// after a time constant.
bool carriage_is_held(const Evidence& evidence);

}  // namespace fidservo::gap
