// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/rig.h"
#include "src/files/rig/rig_file.h"

namespace fidservo {

/// The rig of assets/rig.yaml.
inline const Rig& reference_rig() {
    static const Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    return rig;
}

}  // namespace fidservo
