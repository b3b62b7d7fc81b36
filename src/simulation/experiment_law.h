// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The controller side of an experiment: the commands of a tick from the sensors' readings. The same for
// simulated and real rigs.
#include "control/nonlinear_pd.h"
#include "control/pi_antiwindup.h"
#include "core/recording.h"
#include "src/simulation/experiments.h"

#include <optional>

namespace fidservo {

struct Rig;

/// The states of the controllers that the experiment uses. A run starts with none.
struct ExperimentLoops {
    control::PdState pd;
    control::PidState pid;
    std::optional<control::PiState> pi;
};

/// Fills in the setpoints and the commands of a tick, t_s after the experiment's start, into a row that holds
/// the tick's readings. Setpoints are followed by the published controllers with the rig file's gains; in
/// counts, the macro stage's is
///     floor(setpoint / resolution + 1/2) + zero_count
/// A controller starts anew each time a setpoint comes into force. Commands are clamped to the board's and
/// the heater's range. Does not allocate.
/// @param zero_count  the encoder's reading at place 0, rounded
void command_tick(const Rig& rig, const Experiment& experiment, double zero_count, double t_s,
                  ExperimentLoops& loops, StageRow& row);

/// The names, as in recordings, of the controllers that follow an experiment's setpoints; empty where it has
/// no setpoints.
std::optional<ControllerNames> controllers_of(const Experiment& experiment);

}  // namespace fidservo
