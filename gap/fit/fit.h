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
    double loss = 0.0;  ///< total loss of the fitted windows (gap/fit/score.h), without the prior
    /// Covariance of all parameters in order, by the sandwich estimator from the scatter of the windows'
    /// gradients, which remains valid where errors within a window are dependent. Zero for parameters at a
    /// bound; all zero unless FitOptions::with_covariance is set.
    Eigen::MatrixXd covariance;
    /// Inverse of the loss's second derivatives in the Gauss-Newton approximation, including the prior of the
    /// sizes; zero in the same cases.
    Eigen::MatrixXd curvature_covariance = {};
};

/// Steps of numerical derivatives, in scales of a parameter. For effects that move the carriage, the usual
/// step is large enough that its effect exceeds the scatter from stick-slip. The close step is for the
/// neighbourhood of the optimum, where the usual step would exceed the small range of values that predict the
/// rounded counts equally well. The errors depend smoothly on all other effects: their step is the square
/// root of the relative rounding error, which makes the errors by rounding and by curvature equal (Nocedal,
/// Wright, Numerical Optimization, 2nd ed., 2006, ch. 8.1).
inline constexpr double usual_step = 0.01, close_step = 0.001, smooth_step = 3.45e-4;

/// Tolerance of a fit whose values and covariance are reported, and iterations of one that begins nearby.
inline constexpr double close_tolerance = 1e-6;
inline constexpr int few_iterations = 6;

struct FitOptions {
    int most_iterations = 12;
    /// Relative change of the loss, and of parameters (1e-4 at most), at which a fit ends.
    double tolerance = 1e-4;
    /// Decrease of the loss in one iteration below which the fit ends, where the tolerance demands less; 0:
    /// only the tolerance counts.
    double least_improvement = 0.0;
    bool with_covariance = false;  ///< costs one prediction for each parameter
    /// Whether derivatives are kept from one iteration to the next as long as they predict how the errors
    /// change, with Broyden's rank-one update (Math. Comp. 19, 1965); for predictions that change smoothly.
    bool keeps_slopes = false;
    /// Step of numerical derivatives with respect to parameters of effects that move the carriage.
    double step_scales = usual_step;
    /// Errors up to this many floors, a, count as noise: the loss is 1/2 a^2 log(1 + S_w / a^2). With a at
    /// the level of the present errors a distant start is drawn by all windows, not only by those with the
    /// smallest errors.
    double scale_floors = 1.0;
    /// Prior standard deviation of sizes about zero effect, in typical sizes; keeps small what the windows
    /// cannot distinguish. 0: no prior.
    double expected_sizes = 0.0;
};

/// Minimises the windows' total loss over all parameters of the hypothesis, from the given values and within
/// their bounds, by Levenberg-Marquardt on the windows' errors, reweighted by the loss (Ceres).
/// @param counted  which windows to fit
Fit fit(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
        const Hypothesis& start, const FitOptions& options = {});

}  // namespace fidservo::gap
