#include "gap/search.h"

#include "gap/first_sight.h"
#include "gap/halves.h"
#include "gap/parallel.h"
#include "gap/period_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace fidservo::gap {
namespace {

/// A tie: what is behind the best by fewer standard deviations than this is not told from it.
constexpr double tie_significance = 2.0;

/// Signals from which the parameters of an effect are learnt: those whose prediction it changes at first
/// hand. What moves the carriage shows in the tags as well, but says there what the encoder has said.
bool teaches(const plant::Effect& effect, Signal signal) {
    if (effect.block.starts_with("macro.") && effect.block != "macro.encoder")
        return signal == Signal::encoder;
    const std::vector<Signal> reach = reach_of(effect);
    return std::ranges::find(reach, signal) != reach.end();
}

/// Effects of few parameters are tried first: where one of them leaves nothing, a richer one that does as
/// well is no better explanation.
bool is_simple(const Candidate& candidate) {
    return candidate.effect->parameters.size() <= 2;
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
    std::vector<const Candidate*> open;
    for (const Candidate& candidate : candidates_)
        if (std::ranges::find(added, &candidate) == added.end()) open.push_back(&candidate);
    if (open.empty()) return {};
    trials_ += static_cast<int>(open.size());

    const Wanted looked_at = instructive(evidence_.windows(), half(0), base.mean_squares, options_.windows);
    const Errors base_errors = evidence_.errors(base.of_half[0], looked_at);
    std::vector<double> periods_mm;
    const Wanted first_half = half(0);
    for (const PositionPeriod& period :
         strongest_periods(evidence_, evidence_.errors(base.of_half[0], first_half), first_half)) {
        for (const double steps : {-1.2, -0.6, 0.0, 0.6, 1.2})  // a wave keeps in step over the rail
            periods_mm.push_back(1.0 / (1.0 / period.period_mm + steps * period.step_per_mm));
    }
    std::vector<Trial> trials(open.size());
    std::vector<std::vector<Promise>> promises(open.size());
    const auto promised = [&](std::size_t c) { return promises[c].empty() ? 0.0 : promises[c].front().gain; };
    parallel_for(open.size(), [&](std::size_t c) {
        Wanted wanted = looked_at;
        for (std::size_t w = 0; w < wanted.size(); ++w)
            if (!teaches(*open[c]->effect, evidence_.windows()[w].signal)) wanted[w] = 0;
        promises[c] = at_first_sight(predictor(wanted), evidence_.windows(), wanted, base.of_half[0],
                                     base_errors, *open[c], periods_mm);
        trials[c].candidate = open[c];
    });

    std::vector<std::size_t> order(open.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, std::greater{}, promised);
    constexpr double share_of_best = 0.2;
    const double least = std::max(least_gain, share_of_best * promised(order.front()));
    std::erase_if(order, [&](std::size_t c) { return !(promised(c) > least); });
    if (order.size() > options_.fits) order.resize(options_.fits);

    const auto fit_first_half = [&](std::size_t c) {
        Trial& trial = trials[c];
        double least_loss = std::numeric_limits<double>::infinity();
        for (const Promise& promise : promises[c]) {
            if (promise.gain < 0.5 * promised(c)) continue;
            const Fit fitted = fit_half(0, promise.start, base);
            if (fitted.loss >= least_loss) continue;
            least_loss = fitted.loss;
            trial.fitted.of_half[0] = fitted.hypothesis;
        }
        judge_first_half(base, trial);
    };
    const auto richer =
        std::stable_partition(order.begin(), order.end(), [&](std::size_t c) { return is_simple(*open[c]); });
    const std::span simple(order.begin(), richer), rich(richer, order.end());
    parallel_for(simple.size(), [&](std::size_t k) { fit_first_half(simple[k]); });
    if (std::ranges::any_of(simple, [&](std::size_t c) { return leaves_floor_only(trials[c]); }))
        order.erase(richer, order.end());
    else
        parallel_for(rich.size(), [&](std::size_t k) { fit_first_half(rich[k]); });

    std::ranges::sort(order, std::greater{}, [&](std::size_t c) { return trials[c].gain; });
    constexpr double near_best = 0.5;
    const double best_gain = order.empty() ? 0.0 : trials[order.front()].gain;
    std::erase_if(order, [&](std::size_t c) { return !(trials[c].gain > near_best * best_gain); });
    if (order.size() > options_.leaders) order.resize(options_.leaders);
    parallel_for(order.size(), [&](std::size_t k) {
        Trial& trial = trials[order[k]];
        Hypothesis start = base.of_half[1];
        start.push_back(trial.fitted.of_half[0].back());
        trial.fitted.of_half[1] = fit_half(1, start, base).hypothesis;
        judge(trial.fitted);
        trial.against_base = compared(base, trial.fitted);
        trial.gain = trial.against_base.gain;
        trial.is_leader = true;
    });
    std::ranges::stable_sort(trials, std::greater{},
                             [](const Trial& trial) { return std::pair(trial.is_leader, trial.gain); });
    if (!trials.empty()) prefer_simplest(trials);
    return trials;
}

void Search::prefer_simplest(std::vector<Trial>& trials) const {
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
    Wanted wanted = half(side);
    for (std::size_t w = 0; w < wanted.size(); ++w)
        if (std::ranges::none_of(hypothesis, [&](const plant::EffectSetting& setting) {
                return teaches(*setting.effect, evidence_.windows()[w].signal);
            }))
            wanted[w] = 0;
    return instructive(evidence_.windows(), wanted, mean_squares, options_.windows);
}

Fit Search::fit_half(std::size_t side, const Hypothesis& start, const CrossFit& base) const {
    const Wanted wanted = fitted_windows(side, start, base.mean_squares);
    return fit(predictor(wanted), evidence_.windows(), wanted, start);
}

void Search::judge_first_half(const CrossFit& base, Trial& trial) const {
    const Wanted wanted = fitted_windows(1, trial.fitted.of_half[0], base.mean_squares);
    std::vector<double>& squares = trial.fitted.mean_squares;
    squares = mean_squares(evidence_.windows(), evidence_.errors(trial.fitted.of_half[0], wanted));
    for (std::size_t w = 0; w < wanted.size(); ++w)
        if (!std::isnan(squares[w]))
            trial.gain += window_loss(base.mean_squares[w]) - window_loss(squares[w]);
}

double Search::excess(std::span<const double> mean_squares) const {
    constexpr double floor_square = 1.1;  // what is at most 5 % above the floor is at it
    std::array<double, signal_count> sums{}, counts{};
    for (std::size_t w = 0; w < mean_squares.size(); ++w) {
        if (std::isnan(mean_squares[w])) continue;
        const auto signal = static_cast<std::size_t>(evidence_.windows()[w].signal);
        sums[signal] += mean_squares[w];
        counts[signal] += 1.0;
    }
    double excess = 0.0;
    for (std::size_t s = 0; s < signal_count; ++s)
        if (sums[s] > floor_square * counts[s]) excess += sums[s] / counts[s] - 1.0;
    return excess;
}

bool Search::leaves_floor_only(const Trial& trial) const {
    return excess(trial.fitted.mean_squares) == 0.0;
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
