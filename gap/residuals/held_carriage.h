// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether something holds a carriage that the drive should move.
//
// Static friction does not show in the forces on a sliding carriage (gap/balance/carriage_forces.h). It shows
// if the carriage stands although the command is clearly outside the dead zone; near the dead zone's edge any
// small force can hold it.
#include "gap/evidence.h"

namespace fidservo::gap {

/// Whether the carriage stands under such a command, away from the ends of the rail, for longer than its
/// inertia and a play of a millimetre explain. This must happen at least twice; the motion that the rig file
/// predicts for these times, after one time constant each, must exceed 5 mm in total.
bool carriage_is_held(const Evidence& evidence);

}  // namespace fidservo::gap
