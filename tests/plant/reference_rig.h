#pragma once
#include "core/rig.h"
#include "src/config/rig_file.h"

namespace fidservo::plant {

inline Rig reference_rig() {
    return load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
}

/// A rig with a carriage and nothing else.
inline Rig macro_only_rig() {
    Rig rig = reference_rig();
    rig.micro.reset();
    rig.camera.reset();
    rig.fiducials.reset();
    return rig;
}

}  // namespace fidservo::plant
