// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Weighted nonlinear least squares for models of a grey profile with a handful of parameters.
#include "core/normal_equations.h"
#include "vision/features/normal_law.h"
#include "vision/features/subpixel_edge.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace fidservo::vision {

template <int N>
struct ProfileModelValue {
    double grey;
    Eigen::Matrix<double, N, 1> gradient;
};

/// An independent Gaussian prior for each parameter; precision 0: none.
template <int N>
struct ProfilePrior {
    Eigen::Matrix<double, N, 1> mean;
    Eigen::Matrix<double, N, 1> precision;
};

template <int N>
struct ProfileFit {
    Eigen::Matrix<double, N, 1> parameters;
    Eigen::Matrix<double, N, N> covariance;
    double chi2 = 0.0;
    bool converged = false;
};

/// The mean reading of a pixel of level g that is clipped at white, and its derivative by g:
///     E min(G, w) = g - s (phi(z) - z (1 - Phi(z))),   z = (w - g) / s,   G normal with mean g and std s.
struct ClippedLevel {
    double grey;
    double slope;
};

inline ClippedLevel clip_at_white(double grey, double std) {
    const double z = (white_grey - grey) / std;
    if (z > 6.0) return {grey, 1.0};
    const double below = normal_cdf(z);
    return {grey - std * (normal_density(z) - z * (1.0 - below)), below};
}

/// Gauss-Newton with steps of bounded length. Weights follow from the model's level, not from the sample:
/// weights that depend on a sample's noise would bias the levels.
/// @param model  ProfileModelValue<N>(double t, const Vector& parameters)
/// @param bound  largest step of each parameter; steps below 1e-5 of it end the iteration
template <int N, class Model, class Clamp>
ProfileFit<N> fit_profile(std::span<const EdgeSample> samples, const GreyNoise& noise,
                          const Eigen::Matrix<double, N, 1>& start, const ProfilePrior<N>& prior,
                          const Eigen::Matrix<double, N, 1>& bound, const Model& model, const Clamp& clamp) {
    using Vector = Eigen::Matrix<double, N, 1>;
    using Matrix = Eigen::Matrix<double, N, N>;
    constexpr int most_iterations = 40;
    ProfileFit<N> fit{start, Matrix::Zero()};
    for (int iteration = 0; iteration < most_iterations && !fit.converged; ++iteration) {
        Matrix information = prior.precision.asDiagonal();
        Vector slope = prior.precision.cwiseProduct(prior.mean - fit.parameters);
        fit.chi2 = 0.0;
        for (const EdgeSample& sample : samples) {
            const ProfileModelValue<N> value = model(sample.t_px, fit.parameters);
            const double variance = noise.variance(value.grey);
            const ClippedLevel seen = clip_at_white(value.grey, std::sqrt(variance));
            const Vector gradient = value.gradient * seen.slope;
            const double residual = sample.grey - seen.grey;
            information.noalias() += gradient * gradient.transpose() / variance;
            slope += gradient * (residual / variance);
            fit.chi2 += residual * residual / variance;
        }
        const NormalFactor<N> solver(information);
        if (!solver.has_succeeded() || !solver.is_positive()) return fit;
        const Vector step = solver.solve(slope);
        if (!step.allFinite()) return fit;
        fit.covariance = solver.inverse();
        const double scale = std::min(1.0, 1.0 / step.cwiseQuotient(bound).cwiseAbs().maxCoeff());
        fit.parameters = clamp(Vector(fit.parameters + scale * step));
        fit.converged = (step.cwiseQuotient(bound).cwiseAbs().maxCoeff() < 1e-5);
    }
    return fit;
}

}  // namespace fidservo::vision
