// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How probable recordings are under an explanation that may be incomplete.
//
//     recording = simulator(rig file + effects) + discrepancy + noise
//
// The discrepancy is what no named effect explains. It has a level d_s in each signal s, in floors. The root
// of S_w, the mean square error of a window w in floors, whose expectation under the truth is E_w, is
// distributed by Student's law with four degrees of freedom (heavier tails than a normal one: a window in
// which a carriage was let go at another moment is no outlier):
//
//     log p_w = -1/2 log v_w - 5/2 log(1 + S_w / (4 v_w)),   v_w = E_w + d_s^2
//
// d_s is estimated by maximum likelihood on one half of the windows (gap/evidence/halves.h) and judged on the
// other. So an explanation that explains more needs less d_s and has the higher density; d_s = 0 is "no gap".
//
// Noise differs from window to window, a discrepancy is alike over a recording: n windows that a share rho of
// their variance connects count as n / (1 + (n - 1) rho) independent ones.
//
// Source: Kennedy, O'Hagan, J. R. Stat. Soc. B 63, 2001; the number of independent values: Kish, Survey
// Sampling, 1965, design effect of clusters; the law: Lange, Little, Taylor, J. Am. Stat. Assoc. 84, 1989.
#include "gap/evidence.h"

#include <array>
#include <span>
#include <vector>

namespace fidservo::gap {

/// d_s of each signal, floors; 0 where noise explains what is left, and of signals without windows.
using Discrepancy = std::array<double, signal_count>;

/// By maximum likelihood, in steps of a twentieth; 0 below 0.05 floors.
/// @param mean_squares  S_w of all windows; NaN: not judged
Discrepancy discrepancy_of(std::span<const Window> windows, std::span<const double> mean_squares);

/// As how many independent windows n windows of a recording count, each: 1 / (1 + (n - 1) rho).
double independent_share(double windows, double expected_square, double discrepancy);

/// log p of each recording, up to a constant that all explanations of these windows share; 0 for recordings
/// of which nothing is counted.
/// @param mean_squares  S_w of all windows under the explanation
/// @param counted       windows that count; each has an S_w
/// @param shared        the discrepancy by which the windows of a recording are connected: the same for all
///                      explanations that are compared
std::vector<double> log_densities(const Evidence& evidence, std::span<const double> mean_squares,
                                  const Wanted& counted, const Discrepancy& shared);

}  // namespace fidservo::gap
