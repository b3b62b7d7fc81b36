// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/cross_fit.h"

#include "core/parallel.h"
#include "gap/evidence/halves.h"
#include "gap/fit/gap_size.h"
#include "gap/fit/incremental_prediction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fidservo::gap {
namespace {}  // namespace

CrossFitter::CrossFitter(const Evidence& evidence, std::size_t windows, std::function<bool()> stop)
    : evidence_(evidence), windows_(windows), stop_(std::move(stop)), half_(halves(evidence)) {}

Wanted CrossFitter::half(std::size_t side) const {
    Wanted wanted(half_.size());
    for (std::size_t w = 0; w < half_.size(); ++w) wanted[w] = half_[w] == side ? 1 : 0;
    return wanted;
}

Predict CrossFitter::predictor(Wanted wanted) const {
    return [this, wanted = std::move(wanted)](const Hypothesis& hypothesis) {
        return stop_ && stop_() ? Errors{} : evidence_.errors(hypothesis, wanted);
    };
}

Wanted CrossFitter::instructive_of(std::size_t side, const SignalFlags& signals,
                                   std::span<const double> mean_squares) const {
    return instructive(evidence_.windows(), only_of(evidence_.windows(), half(side), signals), mean_squares,
                       windows_);
}

Fit CrossFitter::fit_places(std::size_t side, const Hypothesis& start, const Places& places,
                            std::span<const double> mean_squares, const FitOptions& options) const {
    const Wanted wanted = instructive_of(side, taught_by(part_of(start, places)), mean_squares);
    IncrementalPrediction whole(evidence_, {}, wanted);
    const Predict predict = [&](const Hypothesis& part) {
        return stop_ && stop_() ? Errors{} : whole(with_part(start, places, part));
    };
    Fit fitted = fit(predict, evidence_.windows(), wanted, part_of(start, places), options);
    fitted.hypothesis = with_part(start, places, fitted.hypothesis);
    return fitted;
}

void CrossFitter::fit_again(CrossFit& cross, const SignalFlags& signals) const {
    parallel_for(2, [&](std::size_t side) {
        Hypothesis& hypothesis = cross.of_half[side];
        for (const Places& places : uncoupled_parts(hypothesis))
            if (meet(taught_by(part_of(hypothesis, places)), signals))
                hypothesis = fit_places(side, hypothesis, places, cross.mean_squares).hypothesis;
    });
    judge(cross);
}

void CrossFitter::judge(CrossFit& cross) const {
    CrossFit unknown;
    unknown.mean_squares.assign(evidence_.windows().size(), std::numeric_limits<double>::quiet_NaN());
    judge_signals(unknown, all_signals, cross);
}

void CrossFitter::judge_beside(const CrossFit& base, const Hypothesis& different, CrossFit& cross) const {
    SignalFlags reached = reached_by(different);
    for (const plant::EffectSetting& setting : different)
        reached = either(reached, concerned_by(*setting.effect, cross.of_half[0]));
    judge_signals(base, reached, cross);
}

void CrossFitter::judge_signals(const CrossFit& base, const SignalFlags& signals, CrossFit& cross) const {
    cross.mean_squares = base.mean_squares;
    parallel_for(2, [&](std::size_t side) {
        const Wanted others = only_of(evidence_.windows(), half(1 - side), signals);
        const std::vector<double> squares =
            mean_squares(evidence_.windows(), evidence_.errors(cross.of_half[side], others));
        for (std::size_t w = 0; w < squares.size(); ++w)
            if (others[w] != 0) cross.mean_squares[w] = squares[w];
    });
    cross.loss = total_loss(cross.mean_squares);
}

Places CrossFitter::met_by(const Hypothesis& base, const plant::EffectSetting& further,
                           Places coupled) const {
    Hypothesis whole = base;
    whole.push_back(further);
    const bool hears_of_carriage = teachers_of(*further.effect)[index_of(Signal::hall)];
    if (!hears_of_carriage || !evidence_.platform_feels_carriage(whole)) return coupled;
    for (std::size_t k = 0; k < base.size(); ++k)
        if (moves_carriage(*base[k].effect) && std::ranges::find(coupled, k) == coupled.end())
            coupled.push_back(k);
    return coupled;
}

SignalFlags CrossFitter::concerned_by(const plant::Effect& effect, const Hypothesis& whole) const {
    SignalFlags concerned = teachers_of(effect);
    if (moves_carriage(effect) && evidence_.platform_feels_carriage(whole))
        concerned[index_of(Signal::hall)] = true;
    return concerned;
}

SignalExcess CrossFitter::excess(std::span<const double> mean_squares) const {
    SignalExcess sums{}, counts{};
    for (std::size_t w = 0; w < mean_squares.size(); ++w) {
        if (std::isnan(mean_squares[w])) continue;
        const std::size_t signal = index_of(evidence_.windows()[w].signal);
        sums[signal] += mean_squares[w];
        counts[signal] += evidence_.windows()[w].expected_square;
    }
    SignalExcess excess{};
    for (std::size_t s = 0; s < signal_count; ++s)
        if (sums[s] > floor_square * counts[s]) excess[s] = sums[s] / counts[s] - 1.0;
    return excess;
}

Comparison CrossFitter::compared(const CrossFit& base, const CrossFit& fitted) const {
    return compare(evidence_.windows(), base.mean_squares, fitted.mean_squares);
}

}  // namespace fidservo::gap
