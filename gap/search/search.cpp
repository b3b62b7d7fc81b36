// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/search.h"

#include "core/parallel.h"
#include "gap/fit/counted_rows.h"
#include "gap/numbers.h"
#include "gap/search/contender.h"
#include "gap/starts/starts.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::gap {
namespace {

/// Of contenders sorted by their scores, best first, those that come near the best one, at most `most`.
template <class Score>
std::span<Search::Contender> near_best(std::span<Search::Contender> sorted, double share, double least,
                                       std::size_t most, const Score& score) {
    if (sorted.empty()) return sorted;
    const double bound = std::max(least, share * score(sorted.front()));
    std::size_t count = 0;
    while (count < std::min(most, sorted.size()) && score(sorted[count]) > bound) ++count;
    return sorted.first(count);
}

/// Describes the step that looks for effects beside a base.
std::string base_in_words(const CrossFit& base) {
    std::vector<std::string_view> names;
    for (const plant::EffectSetting& setting : base.of_half[0]) names.push_back(setting.effect->name);
    return names.empty() ? "first effect" : fmt::format("beside {}", fmt::join(names, ", "));
}

}  // namespace

Search::Search(const Evidence& evidence, const std::vector<Candidate>& candidates,
               const SearchOptions& options)
    : candidates_(candidates),
      options_(options),
      effort_at_start_(evidence.effort()),
      fitter_(evidence, options.windows, [this] { return is_exhausted(); }),
      memory_(candidates.size()),
      first_excess_(fitter_.excess(nothing().mean_squares)) {}

bool Search::is_exhausted() const {
    return is_limited_ &&
           fitter_.evidence().effort() - effort_at_start_ > share_of_effort_ * options_.most_effort;
}

void Search::throw_if_exhausted() const {
    if (is_exhausted()) throw SearchExhausted();
}

void Search::throw_if_over() const {
    if (over_) throw SearchExhausted();
}

CrossFit Search::nothing() const {
    CrossFit cross;
    fitter_.judge(cross);
    return cross;
}

std::vector<Trial> Search::try_all(const CrossFit& base, std::span<const Candidate* const> added,
                                   const Effort& effort) {
    constexpr double share_of_promise = 0.2;
    throw_if_over();
    if (options_.tell) options_.tell(base_in_words(base));
    std::vector<Contender> all = contenders(base, added);
    look_at(base, all);
    std::ranges::sort(all, std::greater{}, &Contender::promised);
    const double enough =
        effort.competitor != nullptr ? share_of_promise * gain_where_looked(base, *effort.competitor) : 0.0;
    const std::span fitted = near_best(all, share_of_promise, std::max(least_gain, enough), effort.fits,
                                       std::mem_fn(&Contender::promised));
    fit_simple_first(base, fitted);
    std::ranges::sort(fitted, std::greater{}, &Contender::gain);
    std::span leaders = near_best(fitted, share_of_gain, 0.0, effort.leaders, std::mem_fn(&Contender::gain));
    parallel_for(leaders.size(), [&](std::size_t k) { fit_second_half(base, leaders[k]); });
    throw_if_exhausted();
    try {
        if (effort.refines) refine(base, all, leaders, effort);
    } catch (const BudgetEnded& ended) {
        end(ended.how());
        std::ranges::sort(leaders, std::greater{}, &Contender::gain);
    }

    put_real_ones_first(base, all);
    std::vector<Trial> trials;
    trials.reserve(candidates_.size());
    for (Contender& contender : all) {
        contender.trial.promised = contender.promised();
        trials.push_back(std::move(contender.trial));
    }
    for (const Candidate& candidate : candidates_)
        if (std::ranges::find(added, &candidate) == added.end() &&
            std::ranges::find(trials, &candidate, &Trial::candidate) == trials.end())
            trials.push_back({.candidate = &candidate});
    return trials;
}

void Search::refine(const CrossFit& base, std::span<Contender> all, std::span<Contender> leaders,
                    const Effort& effort) const {
    for (Contender& leader : leaders)
        if (leader.trial.candidate->step_within_counts > 0.0) fit_closer(base, leader, effort.scatters);
    std::ranges::sort(leaders, std::greater{}, &Contender::gain);
    if (leaders.empty()) return;
    leaders = with_limits(base, all, leaders.size());
    fit_closer(base, leaders.front(), effort.scatters);
    const Candidate* const closest = leaders.front().trial.candidate;
    leaders = with_richer(base, all, leaders.size());
    if (leaders.front().trial.candidate != closest) fit_closer(base, leaders.front(), effort.scatters);
    fit_rivals(base, leaders);
    const auto chosen = leaders.begin() + static_cast<std::ptrdiff_t>(simplest(leaders));
    if (chosen != leaders.begin()) fit_closer(base, *chosen, effort.scatters);
    std::rotate(leaders.begin(), chosen, std::next(chosen));
}

void Search::fit_rivals(const CrossFit& base, std::span<Contender> leaders) const {
    const Contender& best = leaders.front();
    if (!meet(off(best.trial.fitted), best.teachers())) return;
    const double bound = nearly_all * best.gain();
    for (Contender& rival : leaders.subspan(1))
        if (rival.gain() > bound) fit_closer(base, rival, false);
    std::ranges::stable_sort(leaders, std::greater{}, &Contender::gain);
}

std::optional<CrossFit> Search::with(const CrossFit& base, const Candidate& candidate) {
    Contender one = contender(base, candidate);
    fit_first_half(base, std::array{&one});
    throw_if_exhausted();
    if (one.finding->fitted[0].empty()) return {};
    fit_second_half(base, one);
    throw_if_exhausted();
    return std::move(one.trial.fitted);
}

void Search::fit_again(CrossFit& cross, const SignalFlags& signals) const {
    fitter_.fit_again(cross, signals);
    throw_if_exhausted();
}

void Search::remember(const CrossFit& base, const Candidate& candidate, const CrossFit& whole,
                      std::size_t at) {
    const Contender known = contender(base, candidate);
    Finding& finding = *known.finding;
    const auto place = static_cast<std::ptrdiff_t>(at);
    for (std::size_t side = 0; side < 2; ++side) {
        Hypothesis in_order = whole.of_half[side];
        std::rotate(in_order.begin() + place, in_order.begin() + place + 1, in_order.end());
        finding.fitted[side] = known.part(in_order);
    }
    const Evidence& evidence = fitter_.evidence();
    const Wanted wanted = fitter_.instructive_of(0, known.teachers(), base.mean_squares);
    const double gain = gained(evidence.windows(), wanted,
                               mean_squares(evidence.windows(), evidence.errors(base.of_half[0], wanted)),
                               evidence.errors(known.placed(base, 0, finding.fitted[0]), wanted));
    finding.starts = {{finding.fitted[0], gain}};
    finding.is_looked_at = true;
    finding.sought = Sought::among_many;
}

Search::Contender Search::contender(const CrossFit& base, const Candidate& candidate) {
    Places coupled = coupled_with(base.of_half[0], *candidate.effect);
    const Places met = fitter_.met_by(base.of_half[0], {candidate.effect, candidate.shapes.front()}, coupled);
    Finding& finding = memory_.of(static_cast<std::size_t>(&candidate - candidates_.data()),
                                  {part_of(base.of_half[0], met), part_of(base.of_half[1], met)});
    return {{.candidate = &candidate}, std::move(coupled), &finding};
}

std::vector<const Candidate*> Search::in_question(const CrossFit& base,
                                                  std::span<const Candidate* const> added) const {
    const SignalFlags wrong = both(off(base), focus_);
    std::vector<const Candidate*> all;
    for (const Candidate& candidate : candidates_)
        if (std::ranges::find(added, &candidate) == added.end() &&
            meet(teachers_of(*candidate.effect), wrong))
            all.push_back(&candidate);
    return all;
}

std::vector<Search::Contender> Search::contenders(const CrossFit& base,
                                                  std::span<const Candidate* const> added) {
    std::vector<Contender> all;
    for (const Candidate* candidate : in_question(base, added)) all.push_back(contender(base, *candidate));
    return all;
}

void Search::look_at(const CrossFit& base, std::span<Contender> contenders) {
    std::vector<Contender*> fresh;
    for (Contender& contender : contenders)
        if (!contender.finding->is_looked_at) fresh.push_back(&contender);
    if (fresh.empty()) return;
    trials_ += static_cast<int>(fresh.size());

    const std::vector<Window>& windows = fitter_.evidence().windows();
    SignalFlags seen{};
    for (const Contender* contender : fresh) seen = either(seen, contender->teachers());
    const Wanted looked_at = fitter_.instructive_of(0, seen, base.mean_squares);
    const CountedRows rows(windows, looked_at);
    const Wanted all(rows.windows().size(), 1);
    const auto predictor = [&](const Wanted& wanted) -> Predict {
        return [&rows, predict = fitter_.predictor(wanted)](const Hypothesis& hypothesis) {
            return rows.of(predict(hypothesis));
        };
    };
    const Errors base_errors = rows.of(fitter_.evidence().errors(base.of_half[0], looked_at));
    std::vector<const Candidate*> asking;
    asking.reserve(fresh.size());
    for (const Contender* contender : fresh) asking.push_back(contender->trial.candidate);
    const AlongRail along = seen_along_rail(fitter_.evidence(), base.of_half[0], fitter_.half(0), asking);
    std::map<Places, Surroundings> beside;
    for (const Contender* contender : fresh)
        if (!beside.contains(contender->coupled))
            beside.emplace(contender->coupled,
                           surroundings(predictor(looked_at), rows.windows(), all, base.of_half[0],
                                        base_errors, contender->coupled));
    parallel_for(fresh.size(), [&](std::size_t c) {
        const Candidate& candidate = *fresh[c]->trial.candidate;
        const Wanted wanted = only_of(windows, looked_at, fresh[c]->teachers());
        const Surroundings& here = beside.at(fresh[c]->coupled);
        Finding& finding = *fresh[c]->finding;
        finding.starts =
            starts_of(candidate, along, predictor(wanted), rows.windows(), rows.flags_of(wanted), here);
        finding.is_looked_at = true;
    });
}

std::size_t Search::simplest(std::span<const Contender> leaders) const {
    const Trial& first = leaders.front().trial;
    const plant::Effect& explained = *first.candidate->effect;
    const auto does_as_well = [&](const Trial& plainer) {
        return ties(first.fitted, plainer.fitted) || !meet(off(plainer.fitted), teachers_of(explained)) ||
               (is_limit_of(*plainer.candidate->effect, explained) && !is_real(plainer.fitted, first.fitted));
    };
    const auto is_plainer = [](const Candidate& one, const Candidate& other) {
        return is_limit_of(*one.effect, *other.effect) ||
               unrefined_parameters(*one.effect) < unrefined_parameters(*other.effect);
    };
    std::size_t best = 0;
    for (std::size_t k = 1; k < leaders.size(); ++k)
        if (is_plainer(*leaders[k].trial.candidate, *leaders[best].trial.candidate) &&
            does_as_well(leaders[k].trial))
            best = k;
    return best;
}

}  // namespace fidservo::gap
