#include "gap/search.h"

#include "gap/parallel.h"
#include "gap/polish.h"
#include "gap/wave_starts.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <utility>

namespace fidservo::gap {
namespace {

/// A tie: what is behind the best by fewer standard deviations than this is not told from it.
constexpr double tie_significance = 2.0;

/// Effects of few parameters are tried first: where one of them leaves nothing, a richer one that does as
/// well is no better explanation.
bool is_simple(const Candidate& candidate) {
    return candidate.effect->parameters.size() <= 2;
}

/// Whether one half of the recordings has no use for a candidate.
bool vanishes_on_a_half(const Trial& trial) {
    return std::ranges::any_of(trial.fitted.of_half, [&](const Hypothesis& hypothesis) {
        const plant::EffectSetting& fitted = hypothesis.back();
        return std::ranges::all_of(trial.candidate->sizes, [&](std::size_t k) {
            return fitted.values[k] == fitted.effect->parameters[k].vanishing;
        });
    });
}

bool includes(const SignalFlags& all, const SignalFlags& some) {
    for (std::size_t s = 0; s < signal_count; ++s)
        if (some[s] && !all[s]) return false;
    return true;
}

}  // namespace

/// A trial on its way.
struct Search::Contender {
    Trial trial;
    Places coupled;  ///< settings of the base that it is coupled with
    Finding* finding;

    double promised() const { return finding->starts.empty() ? 0.0 : finding->starts.front().gain; }
    double gain() const { return trial.gain; }
    SignalFlags teachers() const { return teachers_of(*trial.candidate->effect); }

    /// The base with the candidate, where that and what it is coupled with have been fitted on a half.
    Hypothesis placed(const CrossFit& base, std::size_t side, const Hypothesis& part) const {
        return extended(base.of_half[side], coupled, part);
    }
    /// What of a whole is kept in a finding.
    Hypothesis part(const Hypothesis& whole) const {
        Hypothesis part = part_of(whole, coupled);
        part.push_back(whole.back());
        return part;
    }
    /// Of a whole, what is fitted.
    Places fitted_places(const CrossFit& base) const {
        Places places = coupled;
        places.push_back(base.of_half[0].size());
        return places;
    }
};

namespace {

/// Of those sorted from the best on, the first that come near it, `most` at most.
template <class Score>
std::span<Search::Contender> near_best(std::span<Search::Contender> sorted, double share, double least,
                                       std::size_t most, const Score& score) {
    if (sorted.empty()) return sorted;
    const double bound = std::max(least, share * score(sorted.front()));
    std::size_t count = 0;
    while (count < std::min(most, sorted.size()) && score(sorted[count]) > bound) ++count;
    return sorted.first(count);
}

}  // namespace

Search::Search(const Evidence& evidence, const std::vector<Candidate>& candidates,
               const SearchOptions& options)
    : candidates_(candidates),
      options_(options),
      fitter_(evidence, options.windows, options.stop),
      memory_(candidates.size()),
      first_excess_(fitter_.excess(nothing().mean_squares)) {}

CrossFit Search::nothing() const {
    CrossFit cross;
    fitter_.judge(cross);
    return cross;
}

std::vector<Trial> Search::try_all(const CrossFit& base, std::span<const Candidate* const> added,
                                   const Effort& effort) {
    constexpr double share_of_promise = 0.2, share_of_gain = 0.5;
    std::vector<Contender> all = contenders(base, added);
    look_at(base, all);
    std::ranges::sort(all, std::greater{}, &Contender::promised);
    const std::span fitted =
        near_best(all, share_of_promise, least_gain, effort.fits, std::mem_fn(&Contender::promised));
    fit_simple_first(base, fitted);
    std::ranges::sort(fitted, std::greater{}, &Contender::gain);
    const std::span leaders =
        near_best(fitted, share_of_gain, 0.0, effort.leaders, std::mem_fn(&Contender::gain));
    const Threads each = leaders.size() > 1 ? Threads::one : Threads::all;
    parallel_for(leaders.size(), [&](std::size_t k) { fit_second_half(base, leaders[k], each); });
    std::ranges::sort(leaders, std::greater{}, &Contender::gain);
    if (!leaders.empty()) {
        fit_closer(base, leaders.front());
        const auto chosen = leaders.begin() + static_cast<std::ptrdiff_t>(simplest(leaders));
        if (chosen != leaders.begin()) fit_closer(base, *chosen);
        std::rotate(leaders.begin(), chosen, std::next(chosen));
    }

    std::vector<Trial> trials;
    trials.reserve(candidates_.size());
    for (Contender& contender : all) trials.push_back(std::move(contender.trial));
    for (const Candidate& candidate : candidates_)
        if (std::ranges::find(added, &candidate) == added.end() &&
            std::ranges::find(trials, &candidate, &Trial::candidate) == trials.end())
            trials.push_back({&candidate, 0.0, false, {}});
    return trials;
}

CrossFit Search::with(const CrossFit& base, const Candidate& candidate) {
    Contender one = contender(base, candidate);
    fit_first_half(base, std::array{&one});
    fit_second_half(base, one, Threads::all);
    return std::move(one.trial.fitted);
}

Search::Contender Search::contender(const CrossFit& base, const Candidate& candidate) {
    Places coupled = coupled_with(base.of_half[0], *candidate.effect);
    const Places met = fitter_.met_by(base.of_half[0], {candidate.effect, candidate.shapes.front()}, coupled);
    Finding& finding = memory_.of(static_cast<std::size_t>(&candidate - candidates_.data()),
                                  {part_of(base.of_half[0], met), part_of(base.of_half[1], met)});
    return {{&candidate, 0.0, false, {}}, std::move(coupled), &finding};
}

std::vector<Search::Contender> Search::contenders(const CrossFit& base,
                                                  std::span<const Candidate* const> added) {
    const SignalFlags wrong = off(base);
    std::vector<Contender> all;
    for (const Candidate& candidate : candidates_)
        if (std::ranges::find(added, &candidate) == added.end() &&
            meet(teachers_of(*candidate.effect), wrong))
            all.push_back(contender(base, candidate));
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
    std::vector<PositionPeriod> periods;
    if (std::ranges::any_of(fresh, [](const Contender* c) { return c->trial.candidate->wave.has_value(); })) {
        const Evidence& evidence = fitter_.evidence();
        const Hypothesis& known = base.of_half[0];
        periods = on_the_rail(strongest_periods(evidence, evidence.errors(known, fitter_.half(0))),
                              evidence.rig(), known);
    }
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
        finding.starts = candidate.wave
                             ? waves_at_first_sight(predict, windows, wanted, here, candidate, periods)
                             : at_first_sight(predict, windows, wanted, here, candidate);
        finding.is_looked_at = true;
    });
}

void Search::fit_simple_first(const CrossFit& base, std::span<Contender> contenders) const {
    std::vector<Contender*> simple, rich;
    for (Contender& contender : contenders)
        (is_simple(*contender.trial.candidate) ? simple : rich).push_back(&contender);
    fit_first_half(base, simple);
    std::erase_if(rich, [&](const Contender* other) {
        return std::ranges::any_of(simple, [&](const Contender* one) {
            return one->gain() > 0.0 && includes(one->teachers(), other->teachers()) &&
                   !meet(off(one->trial.fitted), other->teachers());
        });
    });
    fit_first_half(base, rich);
}

void Search::fit_first_half(const CrossFit& base, std::span<Contender* const> contenders) const {
    constexpr double share_of_best_start = 0.5;
    struct Attempt {
        Contender* contender;
        const Promise* promise;
        Fit fitted;
    };
    std::vector<Attempt> attempts;
    for (Contender* contender : contenders)
        if (contender->finding->fitted[0].empty())
            for (const Promise& promise : contender->finding->starts)
                if (promise.gain >= share_of_best_start * contender->promised())
                    attempts.push_back({contender, &promise, {}});
    parallel_for(attempts.size(), [&](std::size_t k) {
        const Contender& contender = *attempts[k].contender;
        attempts[k].fitted = fitter_.fit_places(0, contender.placed(base, 0, attempts[k].promise->start),
                                                contender.fitted_places(base), base.mean_squares);
    });
    std::map<const Contender*, double> least_loss;
    for (const Attempt& attempt : attempts) {
        constexpr double none_yet = std::numeric_limits<double>::infinity();
        double& least = least_loss.try_emplace(attempt.contender, none_yet).first->second;
        if (attempt.fitted.loss >= least) continue;
        least = attempt.fitted.loss;
        attempt.contender->finding->fitted[0] = attempt.contender->part(attempt.fitted.hypothesis);
    }
    parallel_for(contenders.size(), [&](std::size_t k) { judge_first_half(base, *contenders[k]); });
}

void Search::judge_first_half(const CrossFit& base, Contender& contender) const {
    Trial& trial = contender.trial;
    const Hypothesis& found = contender.finding->fitted[0];
    if (found.empty()) return;
    trial.fitted.of_half[0] = contender.placed(base, 0, found);
    const Wanted others = fitter_.instructive_of(1, contender.teachers(), base.mean_squares);
    trial.fitted.mean_squares = mean_squares(fitter_.evidence().windows(),
                                             fitter_.evidence().errors(trial.fitted.of_half[0], others));
    trial.gain = fitter_.compared(base, trial.fitted).gain;
}

void Search::fit_second_half(const CrossFit& base, Contender& contender, Threads threads) const {
    Finding& finding = *contender.finding;
    if (finding.fitted[1].empty()) {
        const Fit fit =
            fitter_.fit_places(1, contender.placed(base, 1, finding.fitted[0]), contender.fitted_places(base),
                               base.mean_squares, {.threads = threads});
        finding.fitted[1] = contender.part(fit.hypothesis);
    }
    for (std::size_t side = 0; side < 2; ++side)
        contender.trial.fitted.of_half[side] = contender.placed(base, side, finding.fitted[side]);
    judge_both_halves(base, contender);
}

void Search::fit_closer(const CrossFit& base, Contender& contender) const {
    const bool is_wave = contender.trial.candidate->wave.has_value();
    const std::string_view block = contender.trial.candidate->effect->block;
    const bool moves_tags = block == "macro.encoder" || block.starts_with("camera.");
    constexpr int most_times = 3;
    constexpr double worth_it = 0.1, worth_a_simplex = 0.5, nearly_all = 0.98;  // of a signal's excess
    Finding& finding = *contender.finding;
    if (vanishes_on_a_half(contender.trial)) return;
    if (!clears_a_signal(base, contender.trial.fitted, is_wave ? worth_a_simplex : worth_it)) return;
    for (int time = 0; time < most_times && !finding.is_close; ++time) {
        if (!meet(off(contender.trial.fitted), contender.teachers())) return;
        const auto fitted_by = [&](const auto& fit_side) {
            Contender closer = contender;
            parallel_for(2, [&](std::size_t side) { closer.trial.fitted.of_half[side] = fit_side(side); });
            judge_both_halves(base, closer);
            return closer;
        };
        const auto by_simplex = [&](std::size_t side) { return polished(contender, side); };
        const auto by_slopes = [&](double step_scales) {
            return fitted_by(
                [&](std::size_t side) { return fitted_from_there(base, contender, side, step_scales); });
        };
        Contender closer = is_wave ? fitted_by(by_simplex) : by_slopes(usual_step);
        const auto or_else = [&](Contender other) {
            if (other.gain() > closer.gain()) closer = std::move(other);
        };
        const auto is_off = [&] { return meet(off(closer.trial.fitted), closer.teachers()); };
        if (!is_wave && is_off()) or_else(by_slopes(close_step));
        if (!is_wave && is_off() && (moves_tags || clears_a_signal(base, closer.trial.fitted, nearly_all)))
            or_else(fitted_by(by_simplex));
        finding.is_close = closer.gain() < contender.gain() + least_gain;
        if (closer.gain() <= contender.gain()) return;
        for (std::size_t side = 0; side < 2; ++side)
            finding.fitted[side] = contender.part(closer.trial.fitted.of_half[side]);
        contender = std::move(closer);
    }
    finding.is_close = true;
}

Hypothesis Search::fitted_from_there(const CrossFit& base, const Contender& contender, std::size_t side,
                                     double step_scales) const {
    const CrossFit& fitted = contender.trial.fitted;
    return fitter_
        .fit_places(side, fitted.of_half[side], contender.fitted_places(base), fitted.mean_squares,
                    {.tolerance = 1e-7, .step_scales = step_scales})
        .hypothesis;
}

Hypothesis Search::polished(const Contender& contender, std::size_t side) const {
    const std::vector<Window>& windows = fitter_.evidence().windows();
    const Wanted wanted = only_of(windows, fitter_.half(side), contender.teachers());
    return polish(fitter_.predictor(wanted), windows, wanted, contender.trial.fitted.of_half[side])
        .hypothesis;
}

void Search::judge_both_halves(const CrossFit& base, Contender& contender) const {
    Trial& trial = contender.trial;
    fitter_.judge_beside(base, contender.finding->fitted[0], trial.fitted);
    trial.gain = fitter_.compared(base, trial.fitted).gain;
    trial.is_leader = true;
}

std::size_t Search::simplest(std::span<const Contender> leaders) const {
    const Trial& first = leaders.front().trial;
    const plant::Effect& explained = *first.candidate->effect;
    const auto does_as_well = [&](const Trial& plainer) {
        return ties(first.fitted, plainer.fitted) || !meet(off(plainer.fitted), teachers_of(explained)) ||
               (is_limit_of(plainer.candidate->effect->name, explained.name) &&
                !is_real(plainer.fitted, first.fitted));
    };
    const auto parameters = [&](std::size_t k) {
        return leaders[k].trial.candidate->effect->parameters.size();
    };
    std::size_t best = 0;
    for (std::size_t k = 1; k < leaders.size(); ++k)
        if (parameters(k) < parameters(best) && does_as_well(leaders[k].trial)) best = k;
    return best;
}

bool Search::is_real(const CrossFit& without, const CrossFit& with) const {
    constexpr double least_share = 0.3, least_share_of_first = 1e-3;
    const Comparison comparison = fitter_.compared(without, with);
    return clears_a_signal(without, with, least_share, least_share_of_first) &&
           comparison.gain > least_gain &&
           comparison.significance >
               significance_bound(comparison.blocks, std::max(trials_, 1), options_.tail);
}

bool Search::nearly_clears(const CrossFit& without, const CrossFit& with) const {
    return clears_a_signal(without, with, 0.9);
}

bool Search::clears_a_signal(const CrossFit& without, const CrossFit& with, double share,
                             double share_of_first) const {
    const SignalExcess before = fitter_.excess(without.mean_squares),
                       after = fitter_.excess(with.mean_squares);
    for (std::size_t s = 0; s < signal_count; ++s)
        if (after[s] < (1.0 - share) * before[s] &&
            (after[s] == 0.0 || before[s] - after[s] >= share_of_first * first_excess_[s]))
            return true;
    return false;
}

SignalFlags Search::off(const CrossFit& fitted) const {
    const SignalExcess excess = fitter_.excess(fitted.mean_squares);
    SignalFlags flags{};
    for (std::size_t s = 0; s < signal_count; ++s) flags[s] = excess[s] > 0.0;
    return flags;
}

bool Search::is_at_floor(const CrossFit& fitted) const {
    return off(fitted) == SignalFlags{};
}

bool Search::ties(const CrossFit& best, const CrossFit& other) const {
    const Comparison lead = fitter_.compared(other, best);
    return lead.gain < least_gain || lead.significance < tie_significance;
}

}  // namespace fidservo::gap
