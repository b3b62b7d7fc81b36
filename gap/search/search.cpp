// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/search.h"

#include "core/parallel.h"
#include "gap/fit/gap_size.h"
#include "gap/search/contender.h"
#include "gap/search/starts.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::gap {
namespace {

/// An effect ties with the best one if it is behind by fewer standard deviations than this.
constexpr double effect_tie_significance = 2.0;

/// Share of the excess that a signal has before any effect: an effect has to remove as much if it does not
/// bring the signal to its floor.
constexpr double least_share_of_first = 1e-3;

SignalFlags above(const SignalExcess& excess, double bound) {
    SignalFlags flags{};
    for (std::size_t s = 0; s < signal_count; ++s) flags[s] = excess[s] > bound;
    return flags;
}

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

/// Numbers of far-off windows or tags that are no chance: in each half, or in one half and two recordings.
struct Enough {
    std::size_t of_each_half, of_one_half;
};

/// @param runs  for each half, the run of each window or tag that is far off
bool are_enough(const std::array<std::vector<std::size_t>, 2>& runs, const Enough& enough) {
    constexpr std::size_t fewest_runs = 2;
    return std::ranges::all_of(runs,
                               [&](const auto& of_half) { return of_half.size() >= enough.of_each_half; }) ||
           std::ranges::any_of(runs, [&](const auto& of_half) {
               return of_half.size() >= enough.of_one_half &&
                      std::set(of_half.begin(), of_half.end()).size() >= fewest_runs;
           });
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
    constexpr double close_behind = 0.9;
    const Contender& best = leaders.front();
    if (!meet(off(best.trial.fitted), best.teachers())) return;
    const double bound = close_behind * best.gain();
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
    const Errors base_errors = fitter_.evidence().errors(base.of_half[0], looked_at);
    std::vector<const Candidate*> asking;
    asking.reserve(fresh.size());
    for (const Contender* contender : fresh) asking.push_back(contender->trial.candidate);
    const AlongRail along = seen_along_rail(fitter_.evidence(), base.of_half[0], fitter_.half(0), asking);
    std::map<Places, Surroundings> beside;
    for (const Contender* contender : fresh)
        if (!beside.contains(contender->coupled))
            beside.emplace(contender->coupled,
                           surroundings(fitter_.predictor(looked_at), windows, looked_at, base.of_half[0],
                                        base_errors, contender->coupled));
    parallel_for(fresh.size(), [&](std::size_t c) {
        const Candidate& candidate = *fresh[c]->trial.candidate;
        const Wanted wanted = only_of(windows, looked_at, fresh[c]->teachers());
        const Predict predict = fitter_.predictor(wanted);
        const Surroundings& here = beside.at(fresh[c]->coupled);
        Finding& finding = *fresh[c]->finding;
        finding.starts = starts_of(candidate, along, predict, windows, wanted, here);
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

bool Search::is_significant(const Comparison& comparison, double times) const {
    return comparison.significance >
           times * significance_bound(comparison.blocks, std::max(trials_, 1), options_.tail);
}

bool Search::is_no_chance(const CrossFit& without, const CrossFit& with, double times) const {
    const Comparison comparison = fitter_.compared(without, with);
    return comparison.gain > least_gain && is_significant(comparison, times);
}

bool Search::is_real(const CrossFit& without, const CrossFit& with) const {
    constexpr double least_share = 0.3;
    const Comparison comparison = fitter_.compared(without, with);
    return clears_a_signal(without, with, least_share, least_share_of_first) &&
           comparison.gain > least_gain &&
           (is_significant(comparison) || clears_what_is_far_off(without, with));
}

bool Search::clears_what_is_far_off(const CrossFit& without, const CrossFit& with) const {
    // For tags a small excess may remain, since a rolling shutter leaves some shapes off when the stage
    // shakes. Unlike the carriage's motion, shapes do not depend on stick-slip.
    constexpr double next_to_nothing = 1e-3;
    const SignalExcess before = fitter_.excess(without.mean_squares),
                       after = fitter_.excess(with.mean_squares);
    for (std::size_t s = 0; s < signal_count; ++s) {
        const auto signal = static_cast<Signal>(s);
        const double most_left = signal == Signal::tag ? next_to_nothing * before[s] : 0.0;
        if (before[s] > 0.0 && after[s] <= most_left && is_far_off(without, signal)) return true;
    }
    return false;
}

bool Search::is_far_off(const CrossFit& cross, Signal signal) const {
    // Least numbers of windows, and of shapes of tags.
    constexpr Enough windows_enough{3, 6}, shapes_enough{6, 12};
    std::array<std::vector<std::size_t>, 2> runs, runs_of_shapes;
    const std::vector<Window>& windows = fitter_.evidence().windows();
    for (const std::size_t side : {0, 1}) {
        const Wanted half = fitter_.half(side);
        for (std::size_t w = 0; w < windows.size(); ++w)
            if (half[w] != 0 && windows[w].signal == signal && cross.mean_squares[w] > far_off_square)
                runs[side].push_back(windows[w].run);
        if (signal == Signal::tag) runs_of_shapes[side] = runs_of_shapes_far_off(cross, side);
    }
    return are_enough(runs, windows_enough) || are_enough(runs_of_shapes, shapes_enough);
}

std::vector<std::size_t> Search::runs_of_shapes_far_off(const CrossFit& cross, std::size_t side) const {
    const std::vector<Window>& windows = fitter_.evidence().windows();
    const Wanted wanted = only_of(windows, fitter_.half(side), only(Signal::tag));
    const Errors errors = fitter_.evidence().errors(cross.of_half[1 - side], wanted);
    std::vector<std::size_t> runs;
    for (std::size_t w = 0; w < windows.size(); ++w) {
        if (wanted[w] == 0) continue;
        for (std::size_t tag = windows[w].begin; tag < windows[w].end; tag += corner_values) {
            const auto shape = std::span(errors).subspan(tag + 1, corner_values - 1);
            const double square = std::inner_product(shape.begin(), shape.end(), shape.begin(), 0.0);
            if (square > far_off_square * static_cast<double>(shape.size())) runs.push_back(windows[w].run);
        }
    }
    return runs;
}

bool Search::nearly_clears(const CrossFit& without, const CrossFit& with, double share) const {
    return clears_a_signal(without, with, share);
}

bool Search::clears_a_signal(const CrossFit& without, const CrossFit& with, double share,
                             double share_of_first) const {
    const SignalExcess before = fitter_.excess(without.mean_squares),
                       after = fitter_.excess(with.mean_squares);
    constexpr double near_floor = 0.5, hardly_any = 0.05;
    for (std::size_t s = 0; s < signal_count; ++s) {
        const bool is_as_good_as_cleared = after[s] < near_floor && after[s] <= hardly_any * before[s];
        if (after[s] < (1.0 - share) * before[s] &&
            (is_as_good_as_cleared || before[s] - after[s] >= share_of_first * first_excess_[s]))
            return true;
    }
    return false;
}

SignalFlags Search::off(const CrossFit& fitted) const {
    return above(fitter_.excess(fitted.mean_squares), 0.0);
}

SignalFlags Search::far_off(const CrossFit& fitted, double floors) const {
    return above(fitter_.excess(fitted.mean_squares), floors * floors - 1.0);
}

double Search::gap_alone(const plant::EffectSetting& setting) const {
    const Evidence& evidence = fitter_.evidence();
    const Wanted wanted = only_of(evidence.windows(), everything(evidence), reached_by({setting}));
    const Errors nothing = evidence.errors({}, wanted);
    Errors change = evidence.errors({setting}, wanted);
    for (std::size_t k = 0; k < change.size(); ++k) change[k] -= nothing[k];
    std::vector<double> squares = mean_squares(evidence.windows(), change);
    for (std::size_t w = 0; w < squares.size(); ++w) squares[w] = wanted[w] == 0 ? 1.0 : 1.0 + squares[w];
    return total_gap(signal_gaps(evidence, squares, squares)).after;
}

bool Search::is_at_floor(const CrossFit& fitted) const {
    return off(fitted) == SignalFlags{};
}

SignalFlags Search::leaves_much(const CrossFit& fitted) const {
    SignalExcess excess = fitter_.excess(fitted.mean_squares);
    for (std::size_t s = 0; s < signal_count; ++s) excess[s] -= least_share_of_first * first_excess_[s];
    return above(excess, 0.0);
}

bool Search::leaves_little(const CrossFit& fitted) const {
    return leaves_much(fitted) == SignalFlags{};
}

bool Search::ties(const CrossFit& best, const CrossFit& other) const {
    const Comparison lead = fitter_.compared(other, best);
    return lead.gain < least_gain || lead.significance < effect_tie_significance;
}

}  // namespace fidservo::gap
