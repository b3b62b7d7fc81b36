// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What users ask a rig to do, and what they say it has: the words of `simulate`, `record` and Python.
#include "plant/effects/effect.h"
#include "src/simulation/experiments.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fidservo {

/// Stands for two of each experiment that the rig can do (campaign_runs).
inline constexpr const char* whole_campaign = "campaign";

/// An experiment and the recording's name.
struct PlannedExperiment {
    std::string name;
    Experiment experiment;
};

/// Of a kind, or a file that describes one. The recording is named "KIND-1". Throws InputError.
PlannedExperiment planned_experiment(const std::string& asked, const Rig& rig, std::uint64_t seed);

/// All of a campaign. Throws InputError.
std::vector<PlannedExperiment> planned_campaign(const Rig& rig, std::uint64_t seed);

/// What a rig has and its file does not state, as "NAME" or "NAME:PARAMETER=VALUE,...". Where none of these
/// is of the effects file, all of the file act, at their typical values. Throws InputError.
/// @param effects_file  empty: none
std::vector<plant::EffectSetting> effects_of(const std::vector<std::string>& texts,
                                             const std::filesystem::path& effects_file);

}  // namespace fidservo
