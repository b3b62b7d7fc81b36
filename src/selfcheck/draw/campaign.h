// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The recordings from which a case is diagnosed, in memory.
#include "core/recording.h"
#include "src/selfcheck/draw/true_rig.h"
#include "src/simulation/experiments.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace fidservo::selfcheck {

/// Makes a recording with the independent model (reference/) of the true rig, driven by commands that were
/// computed for the nominal rig.
/// @param substeps  integration steps per tick; empty: the model's default
Recording record_run(const Rig& nominal, const TrueRig& true_rig, const CampaignRun& run, std::uint64_t seed,
                     std::optional<int> substeps = {});

/// All recordings of a campaign (campaign_runs), computed on all cores.
std::vector<Recording> record_campaign(const Rig& nominal, const TrueRig& true_rig, std::uint64_t seed,
                                       std::optional<int> substeps = {});

}  // namespace fidservo::selfcheck
