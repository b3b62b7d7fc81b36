// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the diagnosis of a case is given: the recordings of a campaign, in memory.
#include "core/recording.h"
#include "src/selfcheck/draw/true_rig.h"
#include "src/simulation/experiments.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace fidservo::selfcheck {

/// On the independent model (reference/) of the true rig; what is commanded is made for the nominal one.
/// @param substeps  of the model's integration a tick; its own number where it is not given
Recording record_run(const Rig& nominal, const TrueRig& true_rig, const CampaignRun& run, std::uint64_t seed,
                     std::optional<int> substeps = {});

/// All of campaign_runs, on all cores.
std::vector<Recording> record_campaign(const Rig& nominal, const TrueRig& true_rig, std::uint64_t seed,
                                       std::optional<int> substeps = {});

}  // namespace fidservo::selfcheck
