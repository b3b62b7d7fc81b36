// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The devices of a session.
#include "core/plate.h"
#include "src/session/session.h"
#include "src/session/simulated_rig.h"

namespace fidservo {

struct Rig;

/// Stage and camera of a session, and the guardian.
struct RigDevices {
    std::shared_ptr<SimulatedRig> simulated;      ///< set where stage and camera are both simulated
    std::shared_ptr<control::Guardian> guardian;  ///< owns the outputs
    std::shared_ptr<control::Stage> stage;        ///< ticked by the session, or by `loop` where there is one
    std::shared_ptr<control::StageLoop> loop;  ///< set where stage or camera are real: it ticks in real time
    std::shared_ptr<vision::Camera> camera;    ///< what looks at the plate
};

/// Stage and camera as the options name them. What is simulated is the rig as its file (options.sim_rig_file,
/// else the rig's own) describes it, behind a guardian process that holds its outputs; beside a real camera
/// it runs in real time. Call it before the program starts threads. Throws InputError for a device that this
/// program does not drive or that is not there, RunFault where one fails.
RigDevices make_devices(const SessionOptions& options, const Rig& rig, const Plate& printed);

}  // namespace fidservo
