// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How well a recording tells a rig that is as one explanation says from another explanation.
#include "gap/evidence.h"
#include "src/design/explanations.h"

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace fidservo::design {

/// A window's errors e under an explanation and their slopes J by z (Explanation::spread), in what the loss
/// needs of them: their number n and the inner products of (J, e).
struct WindowProducts {
    double count = 0.0;
    Eigen::MatrixXd products;
};

/// Of all windows that have values.
/// @param slopes  one a column of the spread, none if empty
std::vector<WindowProducts> products_of(std::span<const gap::Window> windows, const gap::Errors& errors,
                                        std::span<const gap::Errors> slopes);

struct Adjusted {
    Eigen::VectorXd z;
    double loss = 0.0;
};

/// The least of sum over windows of 1/2 log(1 + |e + J z|^2 / n) + 1/2 |z|^2: what is left of an
/// explanation's errors when its values do what they can, weighed against the recordings that they were found
/// by. Iteratively reweighted least squares; of small errors the closed form 1/2 |P e|^2 / n, P the
/// projection to what no slope can take up, where values are free.
/// @param zero  about which it is linear
Adjusted adjusted(std::span<const WindowProducts> windows, const Eigen::VectorXd& zero);

/// Loss by which the rival, adjusted, does worse than the truth on a recording of that: the logarithm of the
/// odds for the truth that the recording is expected to bring, where a window counts as one value.
/// @param evidence    of the one recording
/// @param truth       that it was made with
/// @param iterations  1: by slopes at the rival's best values, secants over half a standard deviation; more:
///                    as the simulator says, with slopes anew after each step
double log_odds(const gap::Evidence& evidence, const gap::Hypothesis& truth, const Explanation& rival,
                int iterations);

/// The rival's values as adjusted to a recording in so many iterations.
gap::Hypothesis adjusted_to(const gap::Evidence& evidence, const Explanation& rival, int iterations);

}  // namespace fidservo::design
