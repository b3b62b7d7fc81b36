// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The parameters of a hypothesis that predict recordings best.
#include "gap/evidence.h"

#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace fidservo::gap {

/// Errors of a hypothesis, as Evidence::errors gives them; empty if the plant refuses it.
using Predict = std::function<Errors(const Hypothesis&)>;

struct Fit {
    Hypothesis hypothesis;
    double loss = 0.0;  ///< of the windows fitted, as in gap/fit/score.h
    /// Of all parameters in order, from the scatter of the windows' gradients (sandwich), which holds where
    /// errors within a window are not independent. Zero for parameters at a bound, and where it was not asked
    /// for.
    Eigen::MatrixXd covariance;
    /// Inverse of the loss's second derivatives by the slopes of the errors alone, with the expected sizes in
    /// it; likewise.
    Eigen::MatrixXd curvature_covariance = {};
};

/// Steps of differences, in scales of a parameter: from afar, above what friction's events and float errors
/// scatter; near the best values, where such a step reaches beyond those that a place within its count leaves
/// equally good.
inline constexpr double usual_step = 0.01, close_step = 0.001;

/// How errors change with each parameter of a hypothesis, for a fit that goes on near it.
struct KnownSlopes {
    Hypothesis at;
    Errors errors;                     ///< of that hypothesis
    std::vector<Errors> by_parameter;  ///< per scale of each parameter, in order; empty: not known
};

struct FitOptions {
    int most_iterations = 12;
    double tolerance = 1e-4;  ///< of the loss, and of parameters if less, relative, at which a fit ends
    /// Loss by which an iteration has to improve for another one to follow; 0: as the tolerance says.
    double least_improvement = 0.0;
    bool with_covariance = false;  ///< costs a prediction a parameter
    /// Whether slopes are kept while they predict what a step changes, and are corrected by it (Broyden,
    /// Math. Comp. 19, 1965): of predictions that change smoothly.
    bool keeps_slopes = false;
    /// With slopes that are kept: from where a fit may begin, of the same windows and of at least the same
    /// effects; what it ends with is left here. Null: none.
    KnownSlopes* known_slopes = nullptr;
    double step_scales = usual_step;  ///< of differences
    /// Errors up to this many floors count as noise: the loss is 1/2 a^2 log(1 + S_w / a^2) with this a. A
    /// fit that starts far off follows all windows with an a of what is left, not just those nearest to it.
    double scale_floors = 1.0;
    /// Standard deviation that sizes are expected to have about nothing, in typical ones: what the windows
    /// cannot tell apart stays small. 0: any size is as good.
    double expected_sizes = 0.0;
};

/// Minimises the windows' total loss over all parameters of the hypothesis, from the values given, within
/// their bounds: Levenberg-Marquardt on the windows' errors, reweighted by the loss (Ceres).
/// @param counted  which windows to fit
Fit fit(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
        const Hypothesis& start, const FitOptions& options = {});

}  // namespace fidservo::gap
