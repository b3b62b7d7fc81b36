// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/campaign.h"

#include "core/parallel.h"
#include "core/rig.h"
#include "src/simulation/simulate_reference.h"

namespace fidservo::selfcheck {

Recording record_run(const Rig& nominal, const TrueRig& true_rig, const CampaignRun& run, std::uint64_t seed,
                     std::optional<int> substeps) {
    return simulate_reference(true_rig.rig, true_rig.departures,
                              make_experiment(run.kind, nominal, seed, run.name), run.name, seed, nullptr,
                              substeps);
}

std::vector<Recording> record_campaign(const Rig& nominal, const TrueRig& true_rig, std::uint64_t seed,
                                       std::optional<int> substeps) {
    const std::vector<CampaignRun> runs = campaign_runs(nominal);
    std::vector<Recording> recordings(runs.size());
    parallel_for(runs.size(), [&](std::size_t k) {
        recordings[k] = record_run(nominal, true_rig, runs[k], seed, substeps);
    });
    return recordings;
}

}  // namespace fidservo::selfcheck
