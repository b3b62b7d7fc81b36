#include "src/selfcheck/campaign.h"

#include "gap/parallel.h"
#include "src/simulation/experiments.h"
#include "src/simulation/simulate_reference.h"

#include <fmt/format.h>

namespace fidservo::selfcheck {

std::vector<CampaignRun> campaign_runs() {
    std::vector<CampaignRun> runs;
    for (const std::string_view kind : experiment_kinds())
        for (const int copy : {1, 2}) runs.push_back({kind, fmt::format("{}-{}", kind, copy)});
    return runs;
}

Recording record_run(const Rig& nominal, const TrueRig& true_rig, const CampaignRun& run,
                     std::uint64_t seed) {
    return simulate_reference(true_rig.rig, true_rig.departures,
                              make_experiment(run.kind, nominal, seed, run.name), run.name, seed);
}

std::vector<Recording> record_campaign(const Rig& nominal, const TrueRig& true_rig, std::uint64_t seed) {
    const std::vector<CampaignRun> runs = campaign_runs();
    std::vector<Recording> recordings(runs.size());
    gap::parallel_for(runs.size(),
                      [&](std::size_t k) { recordings[k] = record_run(nominal, true_rig, runs[k], seed); });
    return recordings;
}

}  // namespace fidservo::selfcheck
