// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/ties.h"

#include "core/rig.h"
#include "src/design/design_experiment.h"
#include "src/files/rig/stage_keys.h"
#include "src/selfcheck/tally/score.h"
#include "src/simulation/simulate_reference.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::selfcheck {
namespace {

std::vector<std::string> named_by(const gap::Diagnosis& diagnosis) {
    std::vector<std::string> named;
    for (const gap::FoundEffect& found : diagnosis.effects)
        named.push_back(fmt::format("{}", fmt::join(classes_named(found), "|")));
    return named;
}

bool holds_all(const Label& label, const gap::Diagnosis& diagnosis) {
    return std::ranges::all_of(label.effects, [&](const TrueEffect& truth) {
        return std::ranges::any_of(diagnosis.effects, [&](const gap::FoundEffect& found) {
            return classes_named(found).contains(truth.class_name);
        });
    });
}

bool is_resolved(const Label& label, const gap::Diagnosis& diagnosis) {
    return diagnosis.effects.size() == label.effects.size() && holds_all(label, diagnosis) &&
           std::ranges::all_of(diagnosis.effects, [](const gap::FoundEffect& found) {
               return classes_named(found).size() == 1;
           });
}

}  // namespace

std::string words_of(const Tie& tie) {
    const auto settled = [](const std::optional<Settlement>& settlement) -> std::string {
        if (!settlement) return "none";
        return fmt::format("{} {}: {}", settlement->experiment,
                           settlement->is_resolved ? "resolves it" : "leaves",
                           fmt::join(settlement->named, " + "));
    };
    return fmt::format("tie {}; by design: {}; by the list: {}\n", fmt::join(tie.set, " + "),
                       settled(tie.by_design), settled(tie.by_list));
}

std::optional<Tie> settle_tie(const Rig& nominal, const Case& drawn, const std::vector<Recording>& recordings,
                              const gap::Diagnosis& diagnosis, const DiagnoseAgain& diagnose_again) {
    const bool is_tied = std::ranges::any_of(
        diagnosis.effects, [](const gap::FoundEffect& found) { return !found.rivals.empty(); });
    if (!is_tied) return {};
    Tie tie{named_by(diagnosis), holds_all(drawn.label, diagnosis), {}, {}, 0.0};
    const auto start = std::chrono::steady_clock::now();
    const gap::Evidence evidence(nominal, recordings);
    design::OpenQuestion question = design::open_question(evidence, diagnosis);
    question.unknown.reset();
    if (question.duels.empty()) return {};
    const auto budget = std::make_shared<const gap::Budget>();
    const design::Judge judge(nominal, question, watchdog_params(nominal, {}).wire_limit_degC, budget);
    const std::string name = "designed";
    const auto settled = [&](const std::string& origin,
                             const std::optional<design::Candidate>& candidate) -> std::optional<Settlement> {
        if (!candidate) return {};
        std::vector<Recording> all = recordings;
        all.push_back(simulate_reference(drawn.true_rig.rig, drawn.true_rig.departures,
                                         design::experiment_of(candidate->design, origin, nominal),
                                         origin + "-1", drawn.campaign_seed));
        const gap::Diagnosis again = diagnose_again(std::move(all));
        return Settlement{origin, candidate->judgement.value, is_resolved(drawn.label, again),
                          named_by(again)};
    };
    const design::DesignedExperiment designed =
        design::design_experiment(judge, name, budget, design::small_effort);
    tie.design_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!designed.best || designed.best->judgement.value < design::least_log_odds) return tie;
    tie.by_design = settled(name, designed.best);
    const std::optional<design::Candidate> listed = design::best_of_list(judge, designed.decidable);
    tie.by_list = settled(listed ? listed->origin : "", listed);
    return tie;
}

}  // namespace fidservo::selfcheck
