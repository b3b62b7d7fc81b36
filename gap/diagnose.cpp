// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/diagnose.h"

#include "core/input_error.h"
#include "gap/accused.h"
#include "gap/fit/gap_size.h"
#include "gap/notes.h"
#include "gap/parameters.h"
#include "gap/proposal.h"
#include "gap/residuals/accusation.h"
#include "gap/residuals/remainder.h"
#include "gap/verdict/correlated.h"
#include "gap/verdict/model_weights.h"
#include "gap/verdict/standing.h"
#include "gap/verdict/undecided.h"
#include "gap/verdict/unpredictable.h"
#include "plant/effects/catalogue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include <fmt/format.h>

namespace fidservo::gap {
namespace {

std::vector<std::string> indistinguishable(const Choice& choice) {
    std::vector<std::string> names;
    const auto add = [&](std::string_view name) {
        if (name != choice.candidate->effect->name && std::ranges::find(names, name) == names.end())
            names.emplace_back(name);
    };
    for (const plant::Effect* effect : plant::effect_catalogue())
        if (class_of(effect->name) == choice.candidate->class_name) add(effect->name);
    for (const Candidate* tie : choice.ties) add(tie->effect->name);
    return names;
}

std::vector<plant::EffectSetting> rivals(const Choice& choice) {
    std::vector<plant::EffectSetting> settings;
    for (const Candidate* tie : choice.ties) {
        if (tie->class_name == choice.candidate->class_name) continue;
        const auto trial = std::ranges::find(choice.alternatives, tie, &Trial::candidate);
        settings.push_back(trial->fitted.of_half[0].back());
    }
    return settings;
}

std::vector<FoundEffect> found_effects(const Evidence& evidence, const Selection& selection,
                                       const std::vector<Support>& supports, const Fit& fitted) {
    std::vector<FoundEffect> found;
    const std::vector<double>& before = selection.steps.front().mean_squares;
    const std::array<Hypothesis, 2>& halves = selection.steps.back().of_half;
    Eigen::Index first = 0;
    for (std::size_t k = 0; k < selection.choices.size(); ++k) {
        const Choice& choice = selection.choices[k];
        const std::vector<double>& after = selection.steps[k + 1].mean_squares;
        const auto [low, high] = removed_interval(evidence, before, after);
        found.push_back({.effect = std::string(choice.candidate->effect->name),
                         .block = std::string(choice.candidate->effect->block),
                         .probability = calibrated_probability(supports[k]),
                         .support = supports[k],
                         .parameters = parameters_of(fitted.hypothesis[k], {halves[0][k], halves[1][k]},
                                                     fitted.covariance, first),
                         .indistinguishable_from = indistinguishable(choice),
                         .rivals = rivals(choice),
                         .gap_removed = total_gap(signal_gaps(evidence, before, after)).removed(),
                         .gap_removed_low = low,
                         .gap_removed_high = high});
        first += static_cast<Eigen::Index>(fitted.hypothesis[k].values.size());
    }
    return found;
}

/// @param found  the effects that are named
std::vector<TriedEffect> tried_effects(const Evidence& evidence, const Selection& selection,
                                       const std::vector<FoundEffect>& found) {
    const CrossFit& nothing = selection.steps.front();
    const std::vector<double> weights = weights_of_trials(evidence, selection.alone, nothing);
    std::vector<TriedEffect> tried;
    for (std::size_t k = 0; k < selection.alone.size(); ++k) {
        const Trial& trial = selection.alone[k];
        TriedEffect effect{std::string(trial.candidate->effect->name),
                           std::string(trial.candidate->effect->block), 0.0, 0.0};
        const auto named = std::ranges::find(found, effect.effect, &FoundEffect::effect);
        if (!trial.fitted.mean_squares.empty()) {
            const TotalGap gap =
                total_gap(signal_gaps(evidence, nothing.mean_squares, trial.fitted.mean_squares));
            effect.gap_removed = gap.removed();
            if (named == found.end())
                effect.probability =
                    calibrated_probability(support_alone(evidence, trial, nothing, weights[k], gap));
        }
        if (named != found.end()) effect.probability = named->probability;
        tried.push_back(std::move(effect));
    }
    return tried;
}

/// Where effects of several blocks cannot be told apart: the block that can fail in most ways.
std::string likeliest_block(const Choice& choice) {
    const auto ways_of = [](std::string_view block) {
        return std::ranges::count(plant::effect_catalogue(), block,
                                  [](const plant::Effect* effect) { return effect->block; });
    };
    std::string_view likeliest = choice.candidate->effect->block;
    for (const Trial& trial : choice.alternatives) {
        const std::string_view block = trial.candidate->effect->block;
        if (trial.candidate->class_name == choice.candidate->class_name &&
            ways_of(block) > ways_of(likeliest))
            likeliest = block;
    }
    return std::string(likeliest);
}

/// Of each block that one of its effects, as far as the weights tell, is part of the explanation.
std::vector<BlockProbability> blocks_of(const Selection& selection, const std::vector<ChoiceWeights>& weights,
                                        const std::vector<FoundEffect>& found) {
    std::vector<BlockProbability> where;
    for (std::size_t c = 0; c < selection.choices.size(); ++c) {
        const Choice& choice = selection.choices[c];
        const std::string block_of_class = likeliest_block(choice);
        std::map<std::string, double> here;
        for (std::size_t k = 0; k < choice.alternatives.size(); ++k) {
            const Candidate& candidate = *choice.alternatives[k].candidate;
            const double weight = weights[c].of_alternatives[k];
            const bool is_of_class = candidate.class_name == choice.candidate->class_name;
            here[is_of_class ? block_of_class : std::string(candidate.effect->block)] += weight;
        }
        const double weight_of_name = found[c].support.weight;
        const double all = weight_of_name > 0.0 ? found[c].probability / weight_of_name : 0.0;
        for (const auto& [block, weight] : here) accuse(where, block, std::min(1.0, all * weight));
    }
    constexpr double least_probability = 1e-4;
    std::erase_if(where,
                  [](const BlockProbability& block) { return block.probability <= least_probability; });
    return where;
}

/// How sure it is which block of a stage's stretch is accused where nothing is named: if the errors depend on
/// nothing that was found, any of them may be it.
double certainty_of(const Remainder& missing) {
    constexpr double any_of_them = 0.5;
    return stage_of(missing.block) != Stage::camera && missing.depends_on.empty() ? any_of_them : 1.0;
}

/// Where nothing is named, what nearly was: an effect that must not be named left nothing, so that it is what
/// the richer ones of its block come to at a limit; or the errors were found to depend on nothing, but one
/// effect predicts them better than any other.
std::string block_of_nameless(const Selection& selection, const Remainder& remainder) {
    const auto is_of_richer = [&](const Candidate* limit) {
        return std::ranges::all_of(selection.alone, [&](const Trial& trial) {
            return !is_limit_of(*limit->effect, *trial.candidate->effect) ||
                   trial.candidate->effect->block == limit->effect->block;
        });
    };
    const auto limit = std::ranges::find_if(selection.limits, is_of_richer);
    if (limit != selection.limits.end()) return std::string((*limit)->effect->block);
    const bool is_of_carriage = stage_of(remainder.block) == Stage::macro;
    if (!remainder.depends_on.empty() || !is_of_carriage || selection.alone.empty()) return remainder.block;
    const Trial& best = *std::ranges::max_element(selection.alone, {}, &Trial::gain);
    const plant::Effect& effect = *best.candidate->effect;
    return best.gain > least_gain && moves_carriage(effect) ? std::string(effect.block) : remainder.block;
}

/// Leaves out what nobody can predict. Returns how many windows of the encoder that is.
std::ptrdiff_t leave_out_unpredictable(const Evidence& evidence, Selection& selection) {
    const std::vector<bool> left_out = unpredictable_windows(evidence, selection.steps.back());
    std::ptrdiff_t count = 0;
    for (std::size_t w = 0; w < left_out.size(); ++w) {
        if (!left_out[w]) continue;
        for (CrossFit& step : selection.steps)
            step.mean_squares[w] = std::numeric_limits<double>::quiet_NaN();
        count += evidence.windows()[w].signal == Signal::encoder ? 1 : 0;
    }
    return count;
}

Verdict verdict_of(const Selection& selection, bool something_is_left) {
    if (selection.choices.empty()) return something_is_left ? Verdict::unexplained : Verdict::no_gap;
    return something_is_left ? Verdict::partly_explained : Verdict::explained;
}

std::vector<SignalGap> gaps_of(const Evidence& evidence, const Selection& selection) {
    return signal_gaps(evidence, selection.steps.front().mean_squares, selection.steps.back().mean_squares);
}

/// What can be said without another prediction: how large the gap is, the names and how probable they are.
/// @param diagnosis  its signals are known
/// @param left   signals in which something is left
/// @param whole  what the gap depends on where nothing is named; empty where that is unknown
void say_what_is_named(const Evidence& evidence, const Selection& selection, const Fit& fitted,
                       const SignalsLeft& left, const std::optional<Remainder>& whole, Diagnosis& diagnosis) {
    std::vector<ChoiceWeights> weights;
    for (const Choice& choice : selection.choices)
        weights.push_back(weights_of(evidence, choice, selection.steps.back().mean_squares));
    diagnosis.hypothesis = fitted.hypothesis;
    diagnosis.gap = total_gap(diagnosis.signals);
    diagnosis.effects =
        found_effects(evidence, selection, supports(evidence, selection, weights, left, whole), fitted);
    diagnosis.candidates = tried_effects(evidence, selection, diagnosis.effects);
    diagnosis.where = blocks_of(selection, weights, diagnosis.effects);
}

SignalFlags dependent_signals(const std::vector<Remainder>& remainders) {
    SignalFlags dependent{};
    for (const Remainder& remainder : remainders)
        dependent[index_of(*remainder.signal)] = !remainder.depends_on.empty();
    return dependent;
}

/// The first of them, which says the most, with what the others say. Empty if there is none.
std::optional<Remainder> together(const std::vector<Remainder>& remainders) {
    if (remainders.empty()) return {};
    Remainder all = remainders.front();
    for (const Remainder& other : std::span(remainders).subspan(1)) all.text += ". " + other.text;
    return all;
}

/// Which block is accused beside the names, and how likely it is the cause rather than they.
/// @param whole  what the gap depends on where nothing is named, if the names are not credible
void accuse_what_is_left(const Selection& selection, const std::optional<Remainder>& whole,
                         Diagnosis& diagnosis) {
    Remainder& left = *diagnosis.unexplained;
    const double in_names = mean_probability(diagnosis.effects);
    if (selection.choices.empty()) {
        left.block = block_of_nameless(selection, left);
    } else if (whole) {
        left.block = whole->block;  // the names stand in for something else
        if (std::ranges::find(diagnosis.where, left.block, &BlockProbability::block) == diagnosis.where.end())
            diagnosis.where.insert(diagnosis.where.begin(), {left.block, 0.0});
    }
    accuse(diagnosis.where, left.block,
           (1.0 - in_names) * (selection.choices.empty() ? certainty_of(left) : 1.0));
}

/// What the search has found, with what it is worth.
/// @param selection  windows that nobody can predict count no longer in it after that
Diagnosis worked_out(const Evidence& evidence, const std::vector<Candidate>& tried, Selection& selection,
                     const DiagnosisOptions& options) {
    const double tail = options.selection.search.tail;
    Diagnosis diagnosis;
    const std::ptrdiff_t left_out = leave_out_unpredictable(evidence, selection);
    const CrossFit& explained = selection.steps.back();
    diagnosis.signals = gaps_of(evidence, selection);
    const LeftOver left_over(evidence, explained);
    const std::vector<Remainder> left = left_over.remainders(tail);
    const Fit fitted = fit_to_all(evidence, explained);
    std::optional<Remainder> whole;
    const bool is_view_named = std::ranges::any_of(
        selection.choices, [](const Choice& choice) { return shows_in_view(*choice.candidate->effect); });
    if (is_view_named) whole = remainder_of(evidence, selection.steps.front(), tail);
    say_what_is_named(evidence, selection, fitted,
                      {.off = left_over.signals(), .dependent = dependent_signals(left)}, whole, diagnosis);
    diagnosis.unexplained =
        together(options.matters == SignalLimits{} ? left : left_over.remainders(tail, options.matters));
    if (are_credible(diagnosis.effects) || selection.choices.empty())
        whole.reset();
    else if (!whole)
        whole = remainder_of(evidence, selection.steps.front(), tail);
    if (!diagnosis.unexplained && whole) {
        diagnosis.unexplained = whole;
        diagnosis.unexplained->text =
            "the named effects may stand in for another cause; without them, " + whole->text;
    }
    diagnosis.verdict = verdict_of(selection, diagnosis.unexplained.has_value());
    if (diagnosis.unexplained) accuse_what_is_left(selection, whole, diagnosis);
    if (diagnosis.unexplained && selection.choices.empty()) {
        const std::string wanting = what_is_wanting(evidence, selection);
        if (!wanting.empty()) diagnosis.unexplained->text += "; " + wanting;
    }
    diagnosis.notes = correlated_parameters(fitted);
    const std::vector<const Candidate*> hidden = hidden_candidates(evidence, tried, selection);
    for (TriedEffect& candidate : diagnosis.candidates)
        candidate.would_show = std::ranges::none_of(
            hidden, [&](const Candidate* one) { return one->effect->name == candidate.effect; });
    for (std::string& note : undecided(evidence, hidden, selection))
        diagnosis.notes.push_back(std::move(note));
    if (left_out > 0)
        diagnosis.notes.push_back(
            fmt::format("encoder: {} of its windows are not judged: where within a count the carriage stood "
                        "decides which way it goes",
                        left_out));
    return diagnosis;
}

/// The same without another prediction: values as one half gives them, uncertain by how far the other one is
/// from it; if that one was not fitted, by an unknown amount.
Diagnosis as_it_stands(const Evidence& evidence, const Selection& selection, const SignalLimits& matters) {
    Diagnosis diagnosis;
    const Hypothesis& hypothesis = selection.steps.back().of_half[0];
    Eigen::Index parameters = 0;
    for (const plant::EffectSetting& setting : hypothesis)
        parameters += static_cast<Eigen::Index>(setting.values.size());
    const Fit fitted{
        .hypothesis = hypothesis, .loss = 0.0, .covariance = Eigen::MatrixXd::Zero(parameters, parameters)};
    diagnosis.signals = gaps_of(evidence, selection);
    const SignalFlags left = signals_left(diagnosis.signals);
    const bool matters_something = std::ranges::any_of(diagnosis.signals, [&](const SignalGap& signal) {
        const std::size_t index = index_of(signal.signal);
        return left[index] && signal.discrepancy > matters[index];
    });
    say_what_is_named(evidence, selection, fitted, {.off = left, .dependent = left}, {}, diagnosis);
    // What both halves agree on to the last digit was not fitted to one of them.
    for (FoundEffect& effect : diagnosis.effects)
        for (FittedParameter& parameter : effect.parameters)
            if (parameter.std == 0.0) parameter.std = std::numeric_limits<double>::quiet_NaN();
    diagnosis.verdict = verdict_of(selection, matters_something);
    return diagnosis;
}

}  // namespace

Diagnosis diagnose(const Evidence& evidence, const DiagnosisOptions& options) {
    if (evidence.windows().empty())
        throw InputError(
            "recordings: nothing in them can be judged; allowed: half a second of commands and readings "
            "without a gap");
    const std::vector<Candidate> tried =
        candidates(evidence, options.only, options.without, options.formulas);
    const Selection selection = select(evidence, tried, options.selection);
    Diagnosis diagnosis;
    Selection judged = selection;
    Ended ended = selection.ended;
    try {
        diagnosis = worked_out(evidence, tried, judged, options);
    } catch (const BudgetEnded& end) {
        ended = end.how();
        diagnosis = as_it_stands(evidence, selection, options.matters);
    }
    if (ended != Ended::interrupted) {
        const Ended of_equation = propose_equation(evidence, judged, options, diagnosis);
        if (of_equation != Ended::finished) ended = of_equation;
    }
    diagnosis.ended = ended;
    if (!diagnosis.unexplained && is_gap_left(diagnosis.verdict)) {
        diagnosis.unexplained = remainder_at_sight(diagnosis.signals, options.matters);
        if (diagnosis.unexplained) accuse_what_is_left(judged, {}, diagnosis);
    }
    add_notes(evidence, options.matters, diagnosis);
    return diagnosis;
}

}  // namespace fidservo::gap
