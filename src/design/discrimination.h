// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How well a recording distinguishes a rig that behaves as one explanation says from another explanation.
#include "gap/evidence.h"
#include "src/design/explanations.h"

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace fidservo::design {

/// A window's errors e under an explanation and their derivatives J by z (Explanation::spread), reduced to
/// what the loss needs: the number n of values and the inner products of (J, e).
struct WindowProducts {
    double count = 0.0;
    Eigen::MatrixXd products;
};

/// The products of all windows that have values.
/// @param slopes  one for each column of the spread, or none if empty
std::vector<WindowProducts> products_of(std::span<const gap::Window> windows, const gap::Errors& errors,
                                        std::span<const gap::Errors> slopes);

struct Adjusted {
    Eigen::VectorXd z;
    double loss = 0.0;
};

/// The least of sum over windows of 1/2 log(1 + |e + J z|^2 / n) + 1/2 |z|^2: the loss that remains when an
/// explanation's values are adjusted as far as the recordings to which they were fitted allow. Computed by
/// iteratively reweighted least squares; for small errors and free values it is 1/2 |P e|^2 / n, with P the
/// projection orthogonal to all slopes.
/// @param zero  z about which the errors are linearised
Adjusted adjusted(std::span<const WindowProducts> windows, const Eigen::VectorXd& zero);

/// Loss by which the rival, adjusted, does worse than the truth on a recording of that: the logarithm of the
/// odds for the truth that the recording is expected to bring, where a window counts as one value.
/// @param evidence    of the one recording
/// @param truth       that it was made with
/// @param iterations  1: by slopes at the rival's best values, secants over half a standard deviation; more:
///                    as the simulator says, with slopes anew after each step
double log_odds(const gap::Evidence& evidence, const gap::Hypothesis& truth, const Explanation& rival,
                int iterations);

/// The rival's values adjusted to a recording in so many iterations.
gap::Hypothesis adjusted_to(const gap::Evidence& evidence, const Explanation& rival, int iterations);

}  // namespace fidservo::design
