// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The experiments are made on the independent model of the rig (reference/), which identification does not
// use, under the published controllers. Every recording is kept.
#include "core/recording.h"
#include "core/rig.h"
#include "reference/departures.h"
#include "src/simulation/experiments.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace fidservo::reproduce {

struct Laboratory {
    Rig rig;
    std::filesystem::path rig_file;
    std::filesystem::path out;  ///< recordings go to out/recordings/NAME
    std::uint64_t seed = 1;
};

/// Makes an experiment and keeps its recording. The name is also the experiment's kind.
Recording perform(const Laboratory& laboratory, const std::string& name, const Experiment& experiment,
                  const reference::Departures& departures = {});

/// Platform position in mm at each row, by the rig file's Hall curve: what a lab would plot.
std::vector<double> platform_mm(const Rig& rig, const Recording& recording);

/// Carriage position in mm at each row, by the encoder.
std::vector<double> carriage_mm(const Rig& rig, const Recording& recording);

}  // namespace fidservo::reproduce
