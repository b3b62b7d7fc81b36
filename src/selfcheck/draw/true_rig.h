// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The rig on which a case is recorded.
#include "core/rig.h"
#include "reference/departures.h"

namespace fidservo::selfcheck {

/// The true rig is `rig` with `departures`. `rig` is the rig file that the diagnosis gets, unless the case
/// has an effect that is simulated as a change of the rig itself (unlisted_effects.h).
struct TrueRig {
    Rig rig;
    reference::Departures departures;
};

}  // namespace fidservo::selfcheck
