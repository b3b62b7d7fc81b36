#include "gap/search.h"

#include "gap/first_sight.h"
#include "gap/halves.h"
#include "gap/parallel.h"
#include "gap/polish.h"
#include "gap/wave_starts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace fidservo::gap {
namespace {

/// A tie: what is behind the best by fewer standard deviations than this is not told from it.
constexpr double tie_significance = 2.0;

using SignalFlags = std::array<bool, signal_count>;

/// Signals from which the parameters of an effect are learnt: those whose prediction it changes at first
/// hand. What moves the carriage shows in the tags as well, but says there what the encoder has said.
SignalFlags teachers_of(const plant::Effect& effect) {
    SignalFlags teach{};
    for (const Signal signal : reach_of(effect)) teach[index_of(signal)] = true;
    if (effect.block.starts_with("macro.") && effect.block != "macro.encoder")
        teach[index_of(Signal::tag)] = false;
    return teach;
}

/// Those of the windows that are wanted whose signal teaches.
Wanted only_of(std::span<const Window> windows, Wanted wanted, const SignalFlags& teach) {
    for (std::size_t w = 0; w < wanted.size(); ++w)
        if (!teach[index_of(windows[w].signal)]) wanted[w] = 0;
    return wanted;
}

/// Effects of few parameters are tried first: where one of them leaves nothing, a richer one that does as
/// well is no better explanation.
bool is_simple(const Candidate& candidate) {
    return candidate.effect->parameters.size() <= 2;
}

}  // namespace

/// A trial on its way: the values from which its fits may begin, best first.
struct Search::Contender {
    Trial trial;
    std::vector<Promise> starts;

    double promised() const { return starts.empty() ? 0.0 : starts.front().gain; }
    double gain() const { return trial.gain; }
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
    : evidence_(evidence), candidates_(candidates), options_(options), half_(halves(evidence)) {}

CrossFit Search::nothing() const {
    CrossFit cross;
    judge(cross);
    return cross;
}

std::vector<Trial> Search::try_all(const CrossFit& base, std::span<const Candidate* const> added) {
    constexpr double share_of_promise = 0.2, share_of_gain = 0.5;
    std::vector<Contender> contenders = promising(base, added);
    trials_ += static_cast<int>(contenders.size());
    std::ranges::sort(contenders, std::greater{}, &Contender::promised);
    const std::span fitted =
        near_best(contenders, share_of_promise, least_gain, options_.fits, std::mem_fn(&Contender::promised));
    fit_simple_first(base, fitted);
    std::ranges::sort(fitted, std::greater{}, &Contender::gain);
    const std::span leaders =
        near_best(fitted, share_of_gain, 0.0, options_.leaders, std::mem_fn(&Contender::gain));
    parallel_for(leaders.size(), [&](std::size_t k) { fit_second_half(base, leaders[k].trial); });
    std::ranges::sort(leaders, std::greater{}, &Contender::gain);
    if (!leaders.empty()) polish_both_halves(base, leaders.front().trial);

    std::vector<Trial> trials;
    trials.reserve(contenders.size());
    for (Contender& contender : contenders) trials.push_back(std::move(contender.trial));
    std::ranges::stable_sort(trials, std::greater{},
                             [](const Trial& trial) { return std::pair(trial.is_leader, trial.gain); });
    prefer_simplest(trials);
    return trials;
}

std::vector<Search::Contender> Search::promising(const CrossFit& base,
                                                 std::span<const Candidate* const> added) const {
    std::vector<Contender> contenders;
    for (const Candidate& candidate : candidates_)
        if (std::ranges::find(added, &candidate) == added.end())
            contenders.push_back({{&candidate, 0.0, false, {}}, {}});

    const Wanted looked_at = instructive(evidence_.windows(), half(0), base.mean_squares, options_.windows);
    const Errors base_errors = evidence_.errors(base.of_half[0], looked_at);
    std::vector<PositionPeriod> periods;
    if (std::ranges::any_of(contenders,
                            [](const Contender& c) { return c.trial.candidate->wave.has_value(); }))
        periods = strongest_periods(evidence_, evidence_.errors(base.of_half[0], half(0)), half(0));
    parallel_for(contenders.size(), [&](std::size_t c) {
        const Candidate& candidate = *contenders[c].trial.candidate;
        const Wanted wanted = only_of(evidence_.windows(), looked_at, teachers_of(*candidate.effect));
        const auto& windows = evidence_.windows();
        contenders[c].starts =
            candidate.wave
                ? waves_at_first_sight(predictor(wanted), windows, wanted, base.of_half[0], base_errors,
                                       candidate, periods)
                : at_first_sight(predictor(wanted), windows, wanted, base.of_half[0], base_errors, candidate);
    });
    return contenders;
}

void Search::fit_simple_first(const CrossFit& base, std::span<Contender> contenders) const {
    const auto is_simple_one = [](const Contender& c) { return is_simple(*c.trial.candidate); };
    const auto first_rich = std::stable_partition(contenders.begin(), contenders.end(), is_simple_one);
    const auto simple_count = static_cast<std::size_t>(first_rich - contenders.begin());
    const std::span simple = contenders.first(simple_count), rich = contenders.subspan(simple_count);
    parallel_for(simple.size(), [&](std::size_t k) { fit_first_half(base, simple[k]); });
    if (std::ranges::any_of(simple, [&](const Contender& c) { return is_at_floor(c.trial.fitted); })) return;
    parallel_for(rich.size(), [&](std::size_t k) { fit_first_half(base, rich[k]); });
}

void Search::fit_first_half(const CrossFit& base, Contender& contender) const {
    constexpr double share_of_best_start = 0.5;
    Hypothesis& best = contender.trial.fitted.of_half[0];
    double least_loss = std::numeric_limits<double>::infinity();
    for (const Promise& promise : contender.starts) {
        if (promise.gain < share_of_best_start * contender.promised()) continue;
        const Fit fitted = fit_half(0, promise.start, base);
        if (fitted.loss >= least_loss) continue;
        least_loss = fitted.loss;
        best = fitted.hypothesis;
    }
    judge_first_half(base, contender.trial);
}

void Search::fit_second_half(const CrossFit& base, Trial& trial) const {
    Hypothesis start = base.of_half[1];
    start.push_back(trial.fitted.of_half[0].back());
    trial.fitted.of_half[1] = fit_half(1, start, base).hypothesis;
    judge(trial.fitted);
    trial.gain = compared(base, trial.fitted).gain;
    trial.is_leader = true;
}

void Search::polish_both_halves(const CrossFit& base, Trial& trial) const {
    if (!trial.candidate->wave || is_at_floor(trial.fitted)) return;
    const SignalFlags teach = teachers_of(*trial.candidate->effect);
    Trial polished = trial;
    parallel_for(2, [&](std::size_t side) {
        const Wanted wanted = only_of(evidence_.windows(), half(side), teach);
        Hypothesis& hypothesis = polished.fitted.of_half[side];
        hypothesis = polish(predictor(wanted), evidence_.windows(), wanted, hypothesis).hypothesis;
    });
    judge(polished.fitted);
    polished.gain = compared(base, polished.fitted).gain;
    if (polished.gain > trial.gain) trial = std::move(polished);
}

void Search::prefer_simplest(std::vector<Trial>& trials) const {
    if (trials.empty()) return;
    const auto parameters = [](const Trial& trial) { return trial.candidate->effect->parameters.size(); };
    auto best = trials.begin();
    for (auto trial = trials.begin(); trial != trials.end() && trial->is_leader; ++trial)
        if (parameters(*trial) < parameters(*best) && ties(trials.front().fitted, trial->fitted))
            best = trial;
    std::rotate(trials.begin(), best, std::next(best));
}

void Search::fit_again(CrossFit& cross) const {
    if (cross.of_half[0].empty()) return judge(cross);
    parallel_for(2, [&](std::size_t side) {
        cross.of_half[side] = fit_half(side, cross.of_half[side], cross).hypothesis;
    });
    judge(cross);
}

bool Search::is_real(const CrossFit& without, const CrossFit& with) const {
    constexpr double least_share = 0.3;  // of the excess
    const Comparison comparison = compared(without, with);
    const double excess_without = excess(without.mean_squares);
    return excess_without > 0.0 && excess(with.mean_squares) < (1.0 - least_share) * excess_without &&
           comparison.gain > least_gain &&
           comparison.significance >
               significance_bound(comparison.blocks, std::max(trials_, 1), options_.tail);
}

bool Search::ties(const CrossFit& best, const CrossFit& other) const {
    const Comparison lead = compared(other, best);
    return lead.gain < least_gain || lead.significance < tie_significance;
}

Comparison Search::compared(const CrossFit& base, const CrossFit& fitted) const {
    return compare(evidence_.windows(), base.mean_squares, fitted.mean_squares);
}

Wanted Search::half(std::size_t side) const {
    Wanted wanted(half_.size());
    for (std::size_t w = 0; w < half_.size(); ++w) wanted[w] = half_[w] == side ? 1 : 0;
    return wanted;
}

Predict Search::predictor(const Wanted& wanted) const {
    return [this, wanted](const Hypothesis& hypothesis) {
        return options_.stop && options_.stop() ? Errors{} : evidence_.errors(hypothesis, wanted);
    };
}

Wanted Search::fitted_windows(std::size_t side, const Hypothesis& hypothesis,
                              std::span<const double> mean_squares) const {
    SignalFlags teach{};
    for (const plant::EffectSetting& setting : hypothesis) {
        const SignalFlags own = teachers_of(*setting.effect);
        for (std::size_t s = 0; s < signal_count; ++s) teach[s] = teach[s] || own[s];
    }
    return instructive(evidence_.windows(), only_of(evidence_.windows(), half(side), teach), mean_squares,
                       options_.windows);
}

Fit Search::fit_half(std::size_t side, const Hypothesis& start, const CrossFit& base) const {
    const Wanted wanted = fitted_windows(side, start, base.mean_squares);
    return fit(predictor(wanted), evidence_.windows(), wanted, start);
}

void Search::judge_first_half(const CrossFit& base, Trial& trial) const {
    const Wanted wanted = fitted_windows(1, trial.fitted.of_half[0], base.mean_squares);
    trial.fitted.mean_squares =
        mean_squares(evidence_.windows(), evidence_.errors(trial.fitted.of_half[0], wanted));
    trial.gain = compared(base, trial.fitted).gain;
}

double Search::excess(std::span<const double> mean_squares) const {
    constexpr double floor_square = 1.1;  // what is at most 5 % above the floor is at it
    std::array<double, signal_count> sums{}, counts{};
    for (std::size_t w = 0; w < mean_squares.size(); ++w) {
        if (std::isnan(mean_squares[w])) continue;
        const std::size_t signal = index_of(evidence_.windows()[w].signal);
        sums[signal] += mean_squares[w];
        counts[signal] += 1.0;
    }
    double excess = 0.0;
    for (std::size_t s = 0; s < signal_count; ++s)
        if (sums[s] > floor_square * counts[s]) excess += sums[s] / counts[s] - 1.0;
    return excess;
}

bool Search::is_at_floor(const CrossFit& fitted) const {
    return excess(fitted.mean_squares) == 0.0;
}

void Search::judge(CrossFit& cross) const {
    cross.mean_squares.assign(evidence_.windows().size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t side = 0; side < 2; ++side) {
        const Wanted others = half(1 - side);
        const std::vector<double> squares =
            mean_squares(evidence_.windows(), evidence_.errors(cross.of_half[side], others));
        for (std::size_t w = 0; w < squares.size(); ++w)
            if (others[w] != 0) cross.mean_squares[w] = squares[w];
    }
    cross.loss = total_loss(cross.mean_squares);
}

}  // namespace fidservo::gap
