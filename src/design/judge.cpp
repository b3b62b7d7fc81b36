// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/design/judge.h"

#include "core/parallel.h"
#include "gap/evidence.h"
#include "src/design/discrimination.h"
#include "src/record/foresight.h"
#include "src/simulation/simulate.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace fidservo::design {
namespace {

/// Of the noise in all simulated recordings: experiments are compared under the same.
constexpr std::uint64_t noise_seed_of_designs = 1;

}  // namespace

/// What one draw of an explanation says of an experiment.
struct Judge::OfDraw {
    std::optional<std::string> refused;
    std::vector<double> log_odds;  ///< of each duel that the explanation is the truth of
    std::optional<double> information;
};

bool Judge::is_truth(std::size_t explanation) const {
    return std::ranges::find(question_.duels, explanation, &Duel::truth) != question_.duels.end() ||
           (explanation == 0 && question_.unknown);
}

Judge::OfDraw Judge::judge_draw(const Experiment& experiment, std::size_t truth, std::size_t draw,
                                const Depth& depth) const {
    const gap::Hypothesis& hypothesis = question_.explanations[truth].draws[draw];
    Recording recording = simulate(rig_, hypothesis, experiment, experiment.kind, noise_seed_of_designs);
    OfDraw result;
    result.refused = why_not(rig_, experiment, recording, wire_limit_degC_);
    if (result.refused) return result;
    std::vector<Recording> recordings;
    recordings.push_back(std::move(recording));
    const gap::Evidence evidence(rig_, std::move(recordings), budget_);
    for (const Duel& duel : question_.duels)
        if (duel.truth == truth)
            result.log_odds.push_back(
                log_odds(evidence, hypothesis, question_.explanations[duel.rival], depth.iterations));
    if (truth == 0 && question_.unknown) result.information = information(*question_.unknown, evidence);
    return result;
}

Judgement Judge::judge(const Experiment& experiment, const Depth& depth) const {
    Judgement judgement;
    if (budget_) budget_->check();
    judgement.refused = why_not(rig_, experiment, wire_limit_degC_);
    if (judgement.refused) return judgement;
    struct Place {
        std::size_t truth, draw;
    };
    std::vector<Place> places;
    std::vector<std::size_t> draws_of(question_.explanations.size(), 0);
    for (std::size_t truth = 0; truth < draws_of.size(); ++truth) {
        if (!is_truth(truth)) continue;
        draws_of[truth] = std::min(depth.draws, question_.explanations[truth].draws.size());
        const std::size_t all = question_.explanations[truth].draws.size();
        for (std::size_t draw = all - draws_of[truth]; draw < all; ++draw) places.push_back({truth, draw});
    }
    std::vector<OfDraw> of_draws(places.size());
    parallel_for(places.size(), [&](std::size_t k) {
        of_draws[k] = judge_draw(experiment, places[k].truth, places[k].draw, depth);
    });
    for (const OfDraw& of_draw : of_draws)
        if (of_draw.refused) {
            judgement.refused = of_draw.refused;
            return judgement;
        }
    judgement.value = std::numeric_limits<double>::infinity();
    std::vector<std::size_t> next(draws_of.size(), 0);
    for (const Duel& duel : question_.duels) {
        const std::size_t at = next[duel.truth]++;
        double sum = 0.0;
        for (std::size_t k = 0; k < places.size(); ++k)
            if (places[k].truth == duel.truth) sum += of_draws[k].log_odds[at];
        judgement.log_odds.push_back(sum / static_cast<double>(draws_of[duel.truth]));
        judgement.value = std::min(judgement.value, judgement.log_odds.back());
    }
    for (std::size_t k = 0; k < places.size(); ++k)
        if (const auto brings = of_draws[k].information) {
            judgement.information = std::min(judgement.information.value_or(*brings), *brings);
            judgement.value = std::min(judgement.value, *brings);
        }
    return judgement;
}

}  // namespace fidservo::design
