// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The machine that a case is recorded on.
#include "core/rig.h"
#include "reference/departures.h"

namespace fidservo::selfcheck {

/// The rig is what the diagnosis is given, but where an effect that the catalogue lacks changed it.
struct TrueRig {
    Rig rig;
    reference::Departures departures;
};

}  // namespace fidservo::selfcheck
