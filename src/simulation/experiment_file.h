// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Experiments written by users: a YAML file with a sequence of pieces for either stage. docs/formats.md
// describes it.
#include "src/simulation/experiments.h"

#include <filesystem>
#include <string>

namespace fidservo {

/// Reads an experiment and demands that the rig can do it: places within the travels, voltages within the
/// limits, a controller wherever a setpoint is to be followed. Throws InputError.
Experiment load_experiment(const std::filesystem::path& file, const Rig& rig);

/// The same from text; `file` only appears in messages.
Experiment parse_experiment(const std::string& text, const std::filesystem::path& file, const Rig& rig);

/// Whether a command's EXPERIMENT names a file: it ends in .yaml or .yml, or is an existing file and no
/// experiment's name.
bool is_experiment_file(const std::string& argument);

}  // namespace fidservo
