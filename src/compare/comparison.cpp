// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compare/comparison.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "gap/diagnose.h"
#include "gap/fit/fit.h"
#include "gap/fit/gap_size.h"
#include "gap/fit/score.h"
#include "plant/effects/catalogue.h"
#include "src/diagnose/thinned.h"
#include "src/diagnose/time_limit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>

namespace fidservo::compare {
namespace {

constexpr double level = 0.01;

std::shared_ptr<const gap::Budget> budget_for(const std::vector<Recording>& recordings,
                                              const std::function<bool()>& interrupted) {
    const diagnose::TimeLimit limit = diagnose::time_limit(recordings);
    return std::make_shared<const gap::Budget>(limit.search_s, limit.whole_s, interrupted,
                                               gap::Seconds::by_effort);
}

gap::Diagnosis diagnosed(const gap::Evidence& evidence, const std::function<void(std::string_view)>& tell) {
    gap::DiagnosisOptions options;
    options.selection.search.tell = tell;
    return gap::diagnose(evidence, options);
}

std::vector<gap::SignalGap> gaps_of(const gap::Evidence& evidence, const gap::Hypothesis& hypothesis) {
    const std::vector<double> squares =
        gap::mean_squares(evidence.windows(), evidence.errors(hypothesis, gap::everything(evidence)));
    return gap::signal_gaps(evidence, squares, squares);
}

double gap_of(const gap::Evidence& evidence, const gap::Hypothesis& hypothesis) {
    return gap::total_gap(gaps_of(evidence, hypothesis)).before;
}

/// A set may be far from what another set's values predict: first all windows are followed, then those that
/// come near (gap::FitOptions::scale_floors).
gap::Fit fitted(const gap::Evidence& evidence, const gap::Hypothesis& start) {
    const gap::Wanted wanted = gap::everything(evidence);
    const auto predict = [&](const gap::Hypothesis& hypothesis) {
        return evidence.errors(hypothesis, wanted);
    };
    const gap::Fit near = gap::fit(predict, evidence.windows(), wanted, start,
                                   {.scale_floors = std::max(1.0, gap_of(evidence, start))});
    return gap::fit(predict, evidence.windows(), wanted, near.hypothesis, {.with_covariance = true});
}

/// Whether some signal is predicted worse, by what is worth a finding, with another setting at a place of a
/// hypothesis.
bool predicts_worse(const gap::Evidence& evidence, const gap::Hypothesis& own,
                    const plant::EffectSetting& other, std::size_t place) {
    gap::Hypothesis exchanged = own;
    exchanged[place] = other;
    const std::vector<gap::SignalGap> with_own = gaps_of(evidence, own),
                                      with_other = gaps_of(evidence, exchanged);
    for (std::size_t s = 0; s < with_own.size(); ++s)
        if (with_other[s].before >= gap::least_floors * std::max(with_own[s].before, with_own[s].floor))
            return true;
    return false;
}

Rig with_stated(Rig rig, const gap::Hypothesis& hypothesis) {
    for (const plant::EffectSetting& setting : hypothesis) rig.effects.push_back(plant::stated(setting));
    return rig;
}

/// What a diagnosis says that a value is uncertain by, which allows for more than the slopes of one fit do.
double stated_std(const gap::Diagnosis& diagnosis, std::string_view effect, std::string_view parameter) {
    for (const gap::FoundEffect& found : diagnosis.effects)
        for (const gap::FittedParameter& one : found.parameters)
            if (found.effect == effect && one.name == parameter) return one.std;
    return 0.0;
}

std::vector<ParameterPair> pairs_of(const gap::Diagnosis& before, const gap::Fit& fit_before,
                                    const gap::Fit& fit_after) {
    std::vector<ParameterPair> pairs;
    Eigen::Index at = 0;
    for (std::size_t e = 0; e < fit_before.hypothesis.size(); ++e) {
        const plant::EffectSetting& a = fit_before.hypothesis[e];
        const plant::EffectSetting& b = fit_after.hypothesis[e];
        for (std::size_t k = 0; k < a.values.size(); ++k, ++at) {
            const plant::EffectParameter& parameter = a.effect->parameters[k];
            if (parameter.is_choice() ||
                (parameter.is_negligible(a.values[k]) && parameter.is_negligible(b.values[k])))
                continue;
            const double slope_a = std::sqrt(std::max(0.0, fit_before.covariance(at, at)));
            const double slope_b = std::sqrt(std::max(0.0, fit_after.covariance(at, at)));
            const double std_a = std::max(slope_a, stated_std(before, a.effect->name, parameter.name));
            // The second set's slopes say as much too little as the first set's.
            const double std_b = slope_a > 0.0 ? slope_b * std_a / slope_a : std::max(slope_b, std_a);
            const double std = std::hypot(std_a, std_b);
            const double z = std > 0.0 ? std::abs(b.values[k] - a.values[k]) / std : 0.0;
            pairs.push_back({std::string(a.effect->name), std::string(a.effect->block),
                             std::string(parameter.name), std::string(parameter.unit), a.values[k], std_a,
                             b.values[k], std_b, std::erfc(z / std::numbers::sqrt2)});
        }
    }
    return pairs;
}

/// Holm's adjusted p values.
void pay_for_all(std::vector<ParameterPair>& pairs) {
    std::vector<std::size_t> order(pairs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t k) { return pairs[k].p; });
    double largest = 0.0;
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        largest =
            std::max(largest, std::min(1.0, pairs[order[rank]].p * static_cast<double>(pairs.size() - rank)));
        pairs[order[rank]].p = largest;
    }
}

void add_notes(gap::Diagnosis& diagnosis, const std::vector<std::string>& notes) {
    diagnosis.notes.insert(diagnosis.notes.end(), notes.begin(), notes.end());
}

}  // namespace

bool Comparison::has_changed() const {
    return std::ranges::any_of(shared, &ParameterPair::has_changed) || has_news();
}

bool Comparison::has_news() const {
    if (beyond.effects.empty() && !beyond.unexplained) return false;
    return std::ranges::any_of(beyond.signals, [&](const gap::SignalGap& in_b) {
        const auto in_a = std::ranges::find(before.signals, in_b.signal, &gap::SignalGap::signal);
        const double left_in_a = in_a == before.signals.end() ? 0.0 : in_a->after;
        return in_b.before >= gap::least_floors * std::max(left_in_a, in_b.floor);
    });
}

Comparison compare(const Rig& rig, diagnose::ReadRecordings before, diagnose::ReadRecordings after,
                   const std::function<bool()>& interrupted,
                   const std::function<void(std::string_view)>& tell) {
    Comparison comparison;
    auto budget = budget_for(before.recordings, interrupted);
    const gap::Evidence first(rig, diagnose::thinned(std::move(before.recordings), before.notes), budget);
    comparison.before = diagnosed(first, tell);
    add_notes(comparison.before, before.notes);
    budget->end();
    const gap::Hypothesis& names = comparison.before.hypothesis;
    budget = budget_for(after.recordings, interrupted);
    std::vector<Recording> second_set = diagnose::thinned(std::move(after.recordings), after.notes);
    gap::Hypothesis own;
    std::map<std::string, bool> worse;  ///< whether B is predicted worse with A's values of an effect
    {
        const gap::Evidence second(rig, second_set, budget);
        if (second.windows().empty()) throw InputError("B: nothing in these recordings can be judged");
        if (!names.empty()) {
            tell("the same effects in both sets");
            const gap::Fit fit_after = fitted(second, names);
            comparison.shared = pairs_of(comparison.before, fitted(first, names), fit_after);
            own = fit_after.hypothesis;
        }
        comparison.gap_by_before = gap_of(second, names);
        comparison.gap_by_own = gap_of(second, own);
        for (std::size_t e = 0; e < own.size(); ++e)
            worse[std::string(own[e].effect->name)] = predicts_worse(second, own, names[e], e);
    }
    pay_for_all(comparison.shared);
    for (ParameterPair& pair : comparison.shared) pair.has_changed = worse[pair.effect] && pair.p < level;
    const gap::Evidence beside(with_stated(rig, own), std::move(second_set), budget);
    comparison.beyond = diagnosed(beside, tell);
    add_notes(comparison.beyond, after.notes);
    return comparison;
}

}  // namespace fidservo::compare
