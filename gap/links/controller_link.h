// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From setpoints and readings to commands: the rig file's controllers, replayed on what was recorded.
//
// A controller is deterministic: with the gains that the rig file states it gives the recorded command to the
// last digit of the file, so that there is no noise to compare a difference with. Its floor is therefore set
// to 0.1 mV, or to the rounding of the file's digits where that is coarser. Errors are limited to 10 floors,
// a millivolt, so that a rig with another controller shows that without hiding its other errors. Under the
// truth the errors are near 0, not near 1 floor.
//
// A recording can show that its controller is another one only if it claims one: Recording::controllers names
// it, or the recording is of an experiment that the file's controllers define. All other commands are not
// judged, but taken as given.
//
// Firmware may round a setpoint to whole counts or truncate it, and may use the reading of this tick or of
// the last one; and where the last digit of a setpoint in the file leaves its count open
// (RecordingHeader::macro_setpoint_step_mm), several counts are possible. Of all these combinations the one
// that fits best is used.
//
// After missing rows the state of a controller is not known: its last error is known one row later, and its
// integral follows from the first command that is not saturated.
#include "core/recording.h"
#include "gap/evidence/windows.h"

#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::gap {

/// One controller along a recording.
struct ControllerRun {
    std::vector<WindowRows> windows;  ///< where the controller has a setpoint
    std::vector<double> error_V;      ///< replayed minus recorded command, row by row; NaN outside of windows
};

/// Whether a recording claims that a controller of the rig file was in charge of a stage.
bool claims_controller(const Recording& recording);

/// The nonlinear PD, the PD that restarts with each setpoint, or the benchmark PID, as far as the recording
/// claims them: in each stretch the one that fits best. Without windows where none is claimed or the rig file
/// states no gains.
/// @param left_out  rows in which the controller did not run; empty: none. Its state is kept over these rows.
ControllerRun macro_controller_run(const Recording& recording, const Rig& rig,
                                   const std::vector<bool>& left_out = {});

/// The micro stage's controller, a PI with anti-windup. Without windows where the recording does not claim it
/// or the rig file states no gains.
/// @param left_out  rows in which the controller did not run; empty: none
ControllerRun micro_controller_run(const Recording& recording, const Rig& rig,
                                   const std::vector<bool>& left_out = {});

/// The rounding of a command by its digits in the file, r.m.s., but at least 0.1 mV.
double controller_floor_V(const std::vector<double>& command_V);

/// An error in floors, limited to 10 floors.
double counted_floors(double error_V, double floor_V);

}  // namespace fidservo::gap
