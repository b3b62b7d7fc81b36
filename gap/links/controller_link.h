// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From setpoints and readings to commands: the rig file's controllers, replayed on what was recorded.
//
// A controller is deterministic: with the rig file's gains it reproduces the recorded command to the last
// digit of the recording, so that there is no noise. The floor of this signal is therefore set to 0.1 mV, or
// to the rounding of the recorded digits if that is coarser. Errors are limited to 10 floors, so that another
// controller is noticed but does not hide the other errors of a rig. With the true model the errors are near
// 0, not near 1 floor.
//
// Commands are judged only if the recording states that a controller of the rig file made them:
// Recording::controllers names it, or the recording is of an experiment that is defined by these controllers.
// All other commands are taken as given.
//
// Firmware may round a setpoint to whole counts or truncate it, and may use this tick's reading or the
// previous one's. If a setpoint's recorded digits do not determine its count
// (RecordingHeader::macro_setpoint_step_mm), several counts are possible. The combination that fits best is
// used.
//
// After missing rows the controller's state is unknown at first: the previous error is known one row later,
// and the integral follows from the first command that is not saturated.
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

/// The nonlinear PD, the PD that restarts with each setpoint, or the benchmark PID, whichever of those that
/// the recording claims (claims_controller()) fits a stretch best. Without windows if it claims none or the
/// rig file states no gains.
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
