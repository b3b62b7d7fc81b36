// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Runs an experiment on the real or simulated rig of a session: its commands at every tick, and the camera's
// frames meanwhile.
#include "core/result.h"
#include "src/process/progress.h"
#include "src/session/session.h"
#include "src/simulation/experiments.h"

namespace fidservo {

enum class ExperimentEnd {
    whole,
    end_of_travel,  ///< aborted, as the carriage would have left its travel
};

/// Runs an experiment from where its start is (start.h): its voltages, or its setpoints under the rig file's
/// controllers, with counts from the session's encoder zero, rounded. Its last tick, which the experiment
/// itself does not have, switches motor and heater off. What the frames show is kept in the session's
/// recording. Fails with Reason::device or Reason::stopped.
/// @param progress  is told every second of the experiment that has gone by
Result<ExperimentEnd> run_on_rig(Session& session, const Experiment& experiment, Progress& progress);

}  // namespace fidservo
