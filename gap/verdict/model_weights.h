// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The probability of each of several explanations, from its predictions of recordings to which it was not
// fitted.
//
//     w_k = mean over draws of  exp(z_k) / sum_j exp(z_j),    z_k = R sum_r alpha_r log p_kr
//
// alpha is drawn from a Dirichlet distribution over the R recordings (Bayesian bootstrap), so that an
// explanation that predicts some recordings better and others worse does not become certain. Source:
// pseudo-BMA with the Bayesian bootstrap: Yao, Vehtari, Simpson, Gelman, Bayesian Analysis 13, 2018.
#include "gap/fit/predictive_density.h"
#include "gap/search/chain.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// The weights, which sum to 1.
/// @param log_densities  log p_kr of each explanation k: one value for each recording that is used
std::vector<double> model_weights(std::span<const std::vector<double>> log_densities);

/// Weights of an explanation and of its variants in which one of the effects is left out or replaced.
struct ChoiceWeights {
    double without = 0.0;  ///< weight of the other effects alone
    /// in the order of Choice::alternatives; 0 for those that were dropped early.
    std::vector<double> of_alternatives;
};

/// @param choice  an effect of the explanation. Its alternatives were judged at the step of the search at
/// which it was accepted; their gains over it at that step are taken to hold for the final explanation, too
/// @param explained  S_w of all windows under the whole explanation
ChoiceWeights weights_of(const Evidence& evidence, const Choice& choice, std::span<const double> explained);

/// The weight of the first of two explanations, given the mean squares S_w of all windows under each; 1/2
/// where no window is predicted by both.
double weight_of_first(const Evidence& evidence, std::span<const double> first,
                       std::span<const double> second);

/// The weights of effects that were tried alone, in the order of the trials. The weight of the explanation
/// without any effect is 1 minus their sum.
std::vector<double> weights_of_trials(const Evidence& evidence, const std::vector<Trial>& trials,
                                      const CrossFit& nothing);

}  // namespace fidservo::gap
