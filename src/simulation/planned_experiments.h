// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Experiments and effects in the words of the options of `simulate`, `record` and Python.
#include "plant/effects/effect.h"
#include "src/simulation/experiments.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fidservo {

/// The name for two of each experiment that the rig can do (campaign_runs).
inline constexpr const char* whole_campaign = "campaign";

/// An experiment and the name of its recording.
struct PlannedExperiment {
    std::string name;
    Experiment experiment;
};

/// Plans an experiment of a kind, or from a file. The recording is named "KIND-1". Throws InputError.
PlannedExperiment planned_experiment(const std::string& asked, const Rig& rig, std::uint64_t seed);

/// Plans all experiments of a campaign. Throws InputError.
std::vector<PlannedExperiment> planned_campaign(const Rig& rig, std::uint64_t seed);

/// The settings of effects given as "NAME" or "NAME:PARAMETER=VALUE,...". If none of the effects file's
/// effects is named, all of them act, at their typical values. Throws InputError.
/// @param effects_file  empty: none
std::vector<plant::EffectSetting> effects_of(const std::vector<std::string>& texts,
                                             const std::filesystem::path& effects_file);

}  // namespace fidservo
