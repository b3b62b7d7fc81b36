// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an experiment would do to a rig, told in advance from the rig file.
#include "core/recording.h"
#include "src/simulation/experiments.h"

#include <optional>
#include <string>

namespace fidservo {

struct Rig;

/// Why a rig cannot do an experiment, by a simulation of it on the rig as its file describes it: the carriage
/// would leave its travel, or the wire become too hot. Empty if it can.
/// @param wire_limit_degC  empty: the wire cannot be damaged
std::optional<std::string> why_not(const Rig& rig, const Experiment& experiment,
                                   std::optional<double> wire_limit_degC);

/// The same by a recording of it that was made in advance, on whatever the rig is taken for.
std::optional<std::string> why_not(const Rig& rig, const Experiment& experiment, const Recording& recording,
                                   std::optional<double> wire_limit_degC);

}  // namespace fidservo
