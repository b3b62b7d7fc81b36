// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An experiment's law: from what the sensors read at a tick to what is commanded from then on. One for
// simulated rigs and for the one at hand.
#include "control/nonlinear_pd.h"
#include "control/pi_antiwindup.h"
#include "core/recording.h"
#include "src/simulation/experiments.h"

#include <optional>

namespace fidservo {

struct Rig;

/// The controllers' memories, as far as the experiment closes their loops. A run starts with none.
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

/// The controllers that follow an experiment's setpoints, by their names in recordings; empty where it has no
/// setpoints.
std::optional<ControllerNames> controllers_of(const Experiment& experiment);

}  // namespace fidservo
