#pragma once
// What the diagnosis of a case is given: sixteen recordings, in memory.
#include "core/recording.h"
#include "src/selfcheck/true_rig.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::selfcheck {

/// A recording of a campaign. Its name says which experiment it is and no more.
struct CampaignRun {
    std::string_view kind;
    std::string name;
};

/// Two of each kind of experiment.
std::vector<CampaignRun> campaign_runs();

/// On the independent model (reference/) of the true rig; what is commanded is made for the nominal one.
Recording record_run(const Rig& nominal, const TrueRig& true_rig, const CampaignRun& run, std::uint64_t seed);

/// All runs, on all cores.
std::vector<Recording> record_campaign(const Rig& nominal, const TrueRig& true_rig, std::uint64_t seed);

}  // namespace fidservo::selfcheck
