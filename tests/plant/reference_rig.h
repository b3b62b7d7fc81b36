// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/rig.h"
#include "tests/reference_rig.h"

namespace fidservo::plant {

/// A rig with a carriage and nothing else.
inline Rig macro_only_rig() {
    Rig rig = reference_rig();
    rig.micro.reset();
    rig.camera.reset();
    rig.fiducials.reset();
    return rig;
}

}  // namespace fidservo::plant
