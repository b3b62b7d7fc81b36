// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The rig on which a case is recorded.
#include "core/rig.h"
#include "reference/departures.h"

namespace fidservo::selfcheck {

/// `rig` is the file that the diagnosis gets, unless an effect that the catalogue lacks has changed it.
struct TrueRig {
    Rig rig;
    reference::Departures departures;
};

}  // namespace fidservo::selfcheck
