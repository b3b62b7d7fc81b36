// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/verdict/model_weights.h"

#include "core/random.h"
#include "gap/fit/gap_size.h"
#include "gap/fit/score.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fidservo::gap {
namespace {

/// Windows that all of some explanations predict.
class CommonWindows {
  public:
    explicit CommonWindows(std::span<const double> mean_squares) : counted_(mean_squares.size(), 1) {
        restrict_to(mean_squares);
    }

    void restrict_to(std::span<const double> mean_squares) {
        for (std::size_t w = 0; w < counted_.size(); ++w)
            if (std::isnan(mean_squares[w])) counted_[w] = 0;
    }

    const Wanted& counted() const { return counted_; }

    bool are_any() const { return std::ranges::find(counted_, 1) != counted_.end(); }

  private:
    Wanted counted_;
};

/// By how much each recording is more probable under one explanation than under another; empty where no
/// window is predicted by both.
std::vector<double> log_ratios(const Evidence& evidence, std::span<const double> one,
                               std::span<const double> other, std::span<const double> judged,
                               const Discrepancy& shared) {
    CommonWindows common(judged);
    common.restrict_to(one);
    common.restrict_to(other);
    if (!common.are_any()) return {};
    std::vector<double> ratios = log_densities(evidence, one, common.counted(), shared);
    const std::vector<double> others = log_densities(evidence, other, common.counted(), shared);
    for (std::size_t run = 0; run < ratios.size(); ++run) ratios[run] -= others[run];
    return ratios;
}

/// Explanations compared with the one at their beginning, and which of some it is that each of them stands
/// for.
class Comparisons {
  public:
    explicit Comparisons(std::size_t recordings) : log_ratios_{std::vector(recordings, 0.0)} {}

    /// @param ratios  to the first explanation; empty: not to be compared
    void add(std::vector<double> ratios, double* weight) {
        if (ratios.empty()) return;
        log_ratios_.push_back(std::move(ratios));
        of_others_.push_back(weight);
    }

    /// Writes the weights of the others where they were asked for; returns that of the first.
    double weigh() const {
        const std::vector<double> weights = model_weights(log_ratios_);
        for (std::size_t k = 0; k < of_others_.size(); ++k) *of_others_[k] = weights[k + 1];
        return weights.front();
    }

  private:
    std::vector<std::vector<double>> log_ratios_;
    std::vector<double*> of_others_;
};

/// Whether a trial was judged wherever the others were: what was given up early was judged on some windows
/// only.
bool is_judged(const Trial& trial) {
    return trial.is_leader && !trial.fitted.mean_squares.empty();
}

/// Where what is left without an effect was not worked out, only by how much the loss rises.
std::vector<double> spread_evenly(double loss, std::size_t recordings) {
    return std::vector(recordings, -loss / static_cast<double>(recordings));
}

}  // namespace

std::vector<double> model_weights(std::span<const std::vector<double>> log_densities) {
    std::vector<double> weights(log_densities.size(), 0.0);
    if (log_densities.empty() || log_densities.front().empty()) return weights;
    const std::size_t recordings = log_densities.front().size();
    NoiseStream random(1, "Bayesian bootstrap over recordings");
    std::vector<double> shares(recordings), sums(log_densities.size());
    for (int draw = 0; draw < bootstrap_draws; ++draw) {
        double whole = 0.0;
        for (double& share : shares) whole += share = -std::log1p(-random.uniform());
        for (std::size_t k = 0; k < sums.size(); ++k) {
            sums[k] = 0.0;
            for (std::size_t run = 0; run < recordings; ++run)
                sums[k] += static_cast<double>(recordings) * shares[run] / whole * log_densities[k][run];
        }
        const double largest = *std::ranges::max_element(sums);
        double normalisation = 0.0;
        for (double& sum : sums) normalisation += sum = std::exp(sum - largest);
        for (std::size_t k = 0; k < sums.size(); ++k) weights[k] += sums[k] / normalisation / bootstrap_draws;
    }
    return weights;
}

ChoiceWeights weights_of(const Evidence& evidence, const Choice& choice, std::span<const double> explained) {
    const std::size_t recordings = evidence.recordings().size();
    const Discrepancy shared = discrepancy_of(evidence.windows(), explained);
    ChoiceWeights weights{.without = 0.0, .of_alternatives = std::vector(choice.alternatives.size(), 0.0)};
    Comparisons comparisons(recordings);
    comparisons.add(
        choice.left_out.mean_squares.empty()
            ? spread_evenly(choice.loss_without - choice.alternatives.front().fitted.loss, recordings)
            : log_ratios(evidence, choice.left_out.mean_squares, explained, explained, shared),
        &weights.without);
    const CrossFit& itself = choice.alternatives.front().fitted;
    for (std::size_t k = 1; k < choice.alternatives.size(); ++k) {
        const Trial& other = choice.alternatives[k];
        const bool contains_it = is_limit_of(*choice.candidate->effect, *other.candidate->effect);
        if (is_judged(other) && !contains_it)
            comparisons.add(
                log_ratios(evidence, other.fitted.mean_squares, itself.mean_squares, explained, shared),
                &weights.of_alternatives[k]);
    }
    weights.of_alternatives.front() = comparisons.weigh();
    return weights;
}

double weight_of_first(const Evidence& evidence, std::span<const double> first,
                       std::span<const double> second) {
    const std::span<const double> better = total_loss(first) < total_loss(second) ? first : second;
    double of_second = 0.5;
    Comparisons comparisons(evidence.recordings().size());
    comparisons.add(log_ratios(evidence, second, first, first, discrepancy_of(evidence.windows(), better)),
                    &of_second);
    comparisons.weigh();
    return 1.0 - of_second;
}

std::vector<double> weights_of_trials(const Evidence& evidence, const std::vector<Trial>& trials,
                                      const CrossFit& nothing) {
    std::vector<double> weights(trials.size(), 0.0);
    const auto best = std::ranges::find_if(trials, is_judged);
    const Discrepancy shared = discrepancy_of(
        evidence.windows(), best == trials.end() ? nothing.mean_squares : best->fitted.mean_squares);
    Comparisons comparisons(evidence.recordings().size());
    for (std::size_t k = 0; k < trials.size(); ++k)
        if (is_judged(trials[k]))
            comparisons.add(log_ratios(evidence, trials[k].fitted.mean_squares, nothing.mean_squares,
                                       nothing.mean_squares, shared),
                            &weights[k]);
    comparisons.weigh();
    return weights;
}

}  // namespace fidservo::gap
