// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How probable each of several explanations is, by how well it predicts recordings that it was not fitted to.
//
//     w_k = mean over draws of  exp(z_k) / sum_j exp(z_j),    z_k = R sum_r alpha_r log p_kr
//
// alpha is drawn from Dirichlet's law over the R recordings (Bayesian bootstrap): an explanation that gains
// in one recording what it loses in others is not sure to be the better one.
// Source: pseudo-BMA with the Bayesian bootstrap: Yao, Vehtari, Simpson, Gelman, Bayesian Analysis 13, 2018.
#include "gap/fit/predictive_density.h"
#include "gap/search/chain.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// Sum to 1.
/// @param log_densities  log p_kr of each explanation k: one value for each recording that is counted
std::vector<double> model_weights(std::span<const std::vector<double>> log_densities);

/// Of an explanation and what it becomes where one of its effects is left out or exchanged.
struct ChoiceWeights {
    double without = 0.0;                 ///< of the rest alone
    std::vector<double> of_alternatives;  ///< as Choice::alternatives; 0 for what was given up early
};

/// @param choice     of the explanation's. An alternative is judged beside what it was tried beside, and
///                   counts as much better or worse than the explanation as it was than the choice there
/// @param explained  S_w of all windows under the whole explanation
ChoiceWeights weights_of(const Evidence& evidence, const Choice& choice, std::span<const double> explained);

/// Of the first of two explanations, given the mean squares S_w of all windows under each; a half where no
/// window is predicted by both.
double weight_of_first(const Evidence& evidence, std::span<const double> first,
                       std::span<const double> second);

/// Of effects that were tried alone, as the trials; what is missing to 1 is that there is none.
std::vector<double> weights_of_trials(const Evidence& evidence, const std::vector<Trial>& trials,
                                      const CrossFit& nothing);

}  // namespace fidservo::gap
