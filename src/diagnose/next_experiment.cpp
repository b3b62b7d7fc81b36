#include "src/diagnose/next_experiment.h"

#include "gap/evidence/halves.h"
#include "gap/evidence/parallel.h"
#include "gap/fit/fit.h"
#include "gap/fit/score.h"
#include "src/diagnose/words.h"
#include "src/simulation/experiments.h"
#include "src/simulation/simulate.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

constexpr double longest_s = 30.0;
/// Loss that decides: odds of a thousand to one, exp(7), where a window counts as one value.
constexpr double decisive = 7.0;

struct Pair {
    gap::Hypothesis found, rival;
    std::string found_name, rival_name;
};

std::vector<Pair> pairs_of(const gap::Diagnosis& diagnosis) {
    std::vector<Pair> pairs;
    for (std::size_t k = 0; k < diagnosis.effects.size(); ++k)
        for (const plant::EffectSetting& rival : diagnosis.effects[k].rivals) {
            if (std::ranges::find(diagnosis.hypothesis, rival.effect, &plant::EffectSetting::effect) !=
                diagnosis.hypothesis.end())
                continue;  // in the end it was found beside the other
            gap::Hypothesis exchanged = diagnosis.hypothesis;
            exchanged[k] = rival;
            pairs.push_back({diagnosis.hypothesis, exchanged, diagnosis.effects[k].effect,
                             std::string(rival.effect->name)});
        }
    return pairs;
}

/// Loss that a rival, fitted, has beyond the truth on what an experiment would record.
double lack(const Rig& rig, const Experiment& experiment, const gap::Hypothesis& truth,
            const gap::Hypothesis& rival) {
    constexpr std::uint64_t seed = 1;
    const std::string name = experiment.kind + "-next";
    const gap::Evidence evidence(rig, {simulate(rig, truth, experiment, name, seed)});
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

}  // namespace

std::optional<gap::ProposedExperiment> next_experiment(const Rig& rig, const gap::Diagnosis& diagnosis) {
    const std::vector<Pair> pairs = pairs_of(diagnosis);
    if (pairs.empty()) return {};
    std::vector<Proposal> proposals;
    for (const std::string_view kind : experiment_kinds()) {
        if (!missing_for(kind, rig).empty()) continue;
        Experiment experiment = make_experiment(kind, rig, 1, std::string(kind) + "-next");
        if (experiment.duration_s <= longest_s) proposals.push_back({std::move(experiment)});
    }
    if (proposals.empty()) return {};
    gap::parallel_for(proposals.size(), [&](std::size_t k) {
        Proposal& proposal = proposals[k];
        for (const Pair& pair : pairs)
            proposal.separation =
                std::min({proposal.separation, lack(rig, proposal.experiment, pair.found, pair.rival),
                          lack(rig, proposal.experiment, pair.rival, pair.found)});
    });
    const Proposal& best = *std::ranges::max_element(proposals, {}, &Proposal::separation);
    if (!(best.separation >= decisive)) return {};
    gap::ProposedExperiment proposed{best.experiment.kind, {pairs.front().found_name}, {}};
    for (const Pair& pair : pairs)
        for (const std::string& name : {pair.found_name, pair.rival_name})
            if (std::ranges::find(proposed.separates, name) == proposed.separates.end())
                proposed.separates.push_back(name);
    std::vector<std::string> names;
    for (const std::string& name : proposed.separates) names.push_back(readable(name));
    proposed.text =
        fmt::format("Record {} ({:.3g} s): in the simulator it tells {} apart, whichever of them it is.",
                    best.experiment.kind, best.experiment.duration_s, enumerated(names));
    return proposed;
}

}  // namespace fidservo::diagnose
