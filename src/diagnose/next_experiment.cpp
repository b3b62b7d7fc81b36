// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/next_experiment.h"

#include "core/parallel.h"
#include "gap/evidence/halves.h"
#include "gap/fit/fit.h"
#include "gap/fit/score.h"
#include "src/design/design_experiment.h"
#include "src/design/exchanges.h"
#include "src/diagnose/words.h"
#include "src/simulation/experiments.h"
#include "src/simulation/simulate.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

/// Loss that a rival, fitted, has beyond the truth on what an experiment would record.
double lack(const Rig& rig, const Experiment& experiment, const gap::Hypothesis& truth,
            const gap::Hypothesis& rival, const std::shared_ptr<const gap::Budget>& budget) {
    constexpr std::uint64_t seed = 1;
    const std::string name = experiment.kind + "-next";
    const gap::Evidence evidence(rig, {simulate(rig, truth, experiment, name, seed)}, budget);
    const gap::Wanted wanted = gap::everything(evidence);
    const gap::Predict predict = [&](const gap::Hypothesis& hypothesis) {
        return evidence.errors(hypothesis, wanted);
    };
    const double least = gap::total_loss(evidence.windows(), wanted, predict(truth));
    return gap::fit(predict, evidence.windows(), wanted, rival).loss - least;
}

struct Proposal {
    Experiment experiment;
    double separation = std::numeric_limits<double>::infinity();  ///< of the worst pair, both ways
};

/// The one that sets them furthest apart; nothing where the rig can do none.
std::optional<Proposal> best_proposal(const Rig& rig, const gap::Diagnosis& diagnosis,
                                      const std::vector<design::Exchange>& exchanges,
                                      const std::function<bool()>& interrupted) {
    constexpr double never_s = std::numeric_limits<double>::infinity();
    const auto budget = std::make_shared<const gap::Budget>(never_s, never_s, interrupted);
    std::vector<Proposal> proposals;
    for (const std::string_view kind : experiment_kinds()) {
        if (!missing_for(kind, rig).empty()) continue;
        Experiment experiment = make_experiment(kind, rig, 1, std::string(kind) + "-next");
        if (experiment.duration_s <= design::longest_s) proposals.push_back({std::move(experiment)});
    }
    if (proposals.empty()) return {};
    parallel_for(proposals.size(), [&](std::size_t k) {
        Proposal& proposal = proposals[k];
        for (const design::Exchange& exchange : exchanges)
            proposal.separation =
                std::min({proposal.separation,
                          lack(rig, proposal.experiment, diagnosis.hypothesis, exchange.hypothesis, budget),
                          lack(rig, proposal.experiment, exchange.hypothesis, diagnosis.hypothesis, budget)});
    });
    return *std::ranges::max_element(proposals, {}, &Proposal::separation);
}

}  // namespace

std::optional<gap::ProposedExperiment> next_experiment(const Rig& rig, const gap::Diagnosis& diagnosis,
                                                       const std::function<bool()>& interrupted) try {
    const std::vector<design::Exchange> exchanges = design::exchanges(diagnosis);
    if (exchanges.empty()) return {};
    const std::optional<Proposal> best = best_proposal(rig, diagnosis, exchanges, interrupted);
    if (!best || !(best->separation >= design::least_log_odds)) return {};
    gap::ProposedExperiment proposed{best->experiment.kind, {}, {}};
    for (const design::Exchange& exchange : exchanges)
        for (const std::string& name :
             {diagnosis.effects[exchange.place].effect, std::string(exchange.rival->name)})
            if (std::ranges::find(proposed.separates, name) == proposed.separates.end())
                proposed.separates.push_back(name);
    std::vector<std::string> names;
    for (const std::string& name : proposed.separates) names.push_back(readable(name));
    proposed.text =
        fmt::format("Record {} ({:.3g} s): in the simulator it tells {} apart, whichever of them it is.",
                    best->experiment.kind, best->experiment.duration_s, enumerated(names));
    return proposed;
} catch (const gap::BudgetEnded&) {
    return {};
}

}  // namespace fidservo::diagnose
