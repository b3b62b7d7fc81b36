// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The probability density of recordings under an explanation that may be incomplete.
//
//     recording = simulator(rig file + effects) + discrepancy + noise
//
// The discrepancy is what no named effect explains. It has a level d_s in each signal s, in floors. The root
// of S_w, the mean square error of a window w in floors, whose expectation under the truth is E_w, follows
// Student's t distribution with four degrees of freedom. Its tails are heavier than those of a normal
// distribution, so that a window in which stick-slip released the carriage at another moment is no outlier:
//
//     log p_w = -1/2 log v_w - 5/2 log(1 + S_w / (4 v_w)),   v_w = E_w + d_s^2
//
// d_s is estimated by maximum likelihood on one half of the windows (gap/evidence/halves.h) and judged on the
// other. An explanation that explains more therefore needs a smaller d_s and has a higher density; d_s = 0
// means that there is no gap.
//
// Noise is independent between windows, while a discrepancy is common to a recording: n windows in which the
// discrepancy is a fraction rho of the variance count as n / (1 + (n - 1) rho) independent ones.
//
// Source: Kennedy, O'Hagan, J. R. Stat. Soc. B 63, 2001; the number of independent values: Kish, Survey
// Sampling, 1965, design effect of clusters; the law: Lange, Little, Taylor, J. Am. Stat. Assoc. 84, 1989.
#include "gap/evidence.h"

#include <array>
#include <span>
#include <vector>

namespace fidservo::gap {

/// d_s of each signal, floors; 0 if noise explains the errors, and for signals without windows.
using Discrepancy = std::array<double, signal_count>;

/// Maximum-likelihood estimate of d_s on a grid from 0.05 floors upwards in steps of 5 %, or 0 if that is
/// more likely.
/// @param mean_squares  S_w of all windows; NaN: not judged
Discrepancy discrepancy_of(std::span<const Window> windows, std::span<const double> mean_squares);

/// The number of independent windows as which each of n windows of a recording counts: 1 / (1 + (n - 1) rho).
double independent_share(double windows, double expected_square, double discrepancy);

/// log p of each recording, up to a constant that is the same for all explanations of these windows; 0 for
/// recordings without counted windows.
/// @param mean_squares  S_w of all windows under the explanation
/// @param counted       windows that count; each has an S_w
/// @param shared        the discrepancy that determines rho: the same for all explanations that are compared
std::vector<double> log_densities(const Evidence& evidence, std::span<const double> mean_squares,
                                  const Wanted& counted, const Discrepancy& shared);

}  // namespace fidservo::gap
