// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From setpoints and readings to commands: the rig file's controllers, replayed on what was recorded.
//
// A controller is deterministic: with the gains that the rig file states it gives the recorded command to the
// last digit of the file, and there is no noise to compare a difference with. Its floor is therefore set: 0.1
// mV, or the file's digits where they are coarser. A millivolt is 10 floors, and no single value counts more,
// so that a rig with another controller says so without drowning what else is wrong with it. Under the truth
// the errors are near 0, not near 1.
//
// Only a recording that claims a controller can show that it is another one: Recording::controllers names it,
// or the recording is of an experiment that the file's controllers define. All other commands are given.
//
// Firmware is free to round a setpoint to whole counts or to cut it off, and to take this tick's reading or
// the last one's; and a setpoint may have become any count that its last digit in the file leaves open
// (RecordingHeader::macro_setpoint_step_mm). Of all these readings the one that fits best counts.
//
// After rows that are missing a controller is under way: the last error is known a row later, and the
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
    std::vector<WindowRows> windows;  ///< where its setpoint is in force
    std::vector<double> error_V;      ///< replayed minus recorded command, row by row; NaN outside of windows
};

/// Whether a recording claims that a controller of the rig file was in charge of a stage.
bool claims_controller(const Recording& recording);

/// The PD, the PD started anew with each setpoint, or the benchmark PID, as far as they are claimed: in each
/// stretch the one that fits best. No windows where none is claimed or the rig file states no gains.
/// @param left_out  rows in which the controller was not asked; empty: none. It goes on behind them.
ControllerRun macro_controller_run(const Recording& recording, const Rig& rig,
                                   const std::vector<bool>& left_out = {});

/// The PI with anti-windup, likewise.
ControllerRun micro_controller_run(const Recording& recording, const Rig& rig,
                                   const std::vector<bool>& left_out = {});

/// What the file's digits leave of a command, at least 0.1 mV.
double controller_floor_V(const std::vector<double>& command_V);

/// Error in floors, as it counts.
double counted_floors(double error_V, double floor_V);

}  // namespace fidservo::gap
