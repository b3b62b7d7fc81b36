#pragma once
// Which hardware a session is given.
#include "core/plate.h"
#include "core/rig.h"
#include "src/session/session.h"
#include "src/session/simulated_rig.h"

namespace fidservo {

struct SimulatedDevices {
    std::shared_ptr<SimulatedRig> rig;
    std::shared_ptr<control::Guardian> guardian;
    std::shared_ptr<control::Stage> stage;
    std::shared_ptr<vision::Camera> camera;
};

/// The simulated rig as its file (options.sim_rig_file, else the rig's own) describes it, behind a guardian
/// process that holds its outputs. Call it before the program starts threads. Throws InputError if the
/// options name other devices than this program drives.
SimulatedDevices make_simulated_devices(const SessionOptions& options, const Rig& rig, const Plate& printed);

}  // namespace fidservo
