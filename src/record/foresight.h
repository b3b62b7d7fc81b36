// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Checks by simulation whether an experiment is safe for a rig.
#include "core/recording.h"
#include "src/simulation/experiments.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fidservo {

struct Rig;

/// Why a rig cannot do an experiment, from a simulation of the rig file: the carriage would leave its travel,
/// or the wire become too hot. Empty if it can.
/// @param wire_limit_degC  empty: the wire cannot be damaged
std::optional<std::string> why_not(const Rig& rig, const Experiment& experiment,
                                   std::optional<double> wire_limit_degC);

/// The same from a recording that was simulated beforehand, with any model of the rig.
std::optional<std::string> why_not(const Rig& rig, const Experiment& experiment, const Recording& recording,
                                   std::optional<double> wire_limit_degC);

/// An experiment whose excitation was drawn for a rig.
struct DrawnExperiment {
    Experiment experiment;
    std::optional<std::string> why_not;  ///< why the rig cannot do it; empty if it can
};

/// The first of several draws of a kind of experiment that a rig can do; where it can do none of them, the
/// first. The first draw is that of make_experiment() with the same arguments, which `simulate` records.
DrawnExperiment draw_for(const Rig& rig, std::string_view kind, std::uint64_t seed,
                         std::string_view recording_name, std::optional<double> wire_limit_degC);

}  // namespace fidservo
