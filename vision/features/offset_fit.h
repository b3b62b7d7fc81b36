// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Robust weighted linear least squares for the change of a shape's parameters that brings its outline onto
// the measured edge points.
#include "core/median.h"
#include "core/normal_equations.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace fidservo::vision {

/// An edge point measured at `offset_px` from the outline; a change p of the shape's parameters moves the
/// outline there by row . p.
template <int N>
struct OutlineOffset {
    Eigen::Matrix<double, N, 1> row;
    double offset_px;
    double std_px;
};

template <int N>
struct OffsetFit {
    Eigen::Matrix<double, N, 1> correction;
    Eigen::Matrix<double, N, N> covariance;  ///< from the offsets' own uncertainties, not widened by `excess`
    double excess = 1.0;                     ///< r.m.s. residual of the offsets used over its expectation
    std::vector<bool> used{};
    int used_count = 0;
    bool determined = false;
};

/// Least absolute deviations first (iteratively reweighted), then least squares on the offsets whose residual
/// is within 4.5 standard deviations, which are enlarged to the median residual where that is larger than
/// expected.
template <int N>
OffsetFit<N> fit_offsets(const std::vector<OutlineOffset<N>>& offsets) {
    using Vector = Eigen::Matrix<double, N, 1>;
    using Matrix = Eigen::Matrix<double, N, N>;
    constexpr double cut = 4.5;
    constexpr int absolute_rounds = 12;
    constexpr int rounds = absolute_rounds + 5;
    OffsetFit<N> fit{Vector::Zero(), Matrix::Zero()};
    fit.used.assign(offsets.size(), true);
    if (offsets.size() < N) return fit;
    std::vector<double> residuals(offsets.size(), 0.0);
    for (int round = 0; round < rounds; ++round) {
        const bool absolute = round < absolute_rounds;
        Matrix information = Matrix::Zero();
        Vector right = Vector::Zero();
        double chi2 = 0.0;
        fit.used_count = 0;
        for (std::size_t k = 0; k < offsets.size(); ++k) {
            if (!fit.used[k]) continue;
            const auto& [row, offset, std] = offsets[k];
            const double softening = absolute && round > 0 ? std::max(1.0, std::abs(residuals[k])) : 1.0;
            const double weight = 1.0 / (std * std * softening);
            information.noalias() += weight * row * row.transpose();
            right += weight * offset * row;
            ++fit.used_count;
        }
        const NormalFactor<N> solver(information);
        fit.determined =
            fit.used_count >= N && solver.has_succeeded() && solver.reciprocal_condition() > 1e-12;
        if (!fit.determined) return fit;
        fit.correction = solver.solve(right);
        fit.covariance = solver.inverse();
        std::vector<double> sizes(offsets.size());
        for (std::size_t k = 0; k < offsets.size(); ++k) {
            residuals[k] = (offsets[k].offset_px - offsets[k].row.dot(fit.correction)) / offsets[k].std_px;
            sizes[k] = std::abs(residuals[k]);
            if (fit.used[k]) chi2 += residuals[k] * residuals[k];
        }
        fit.excess = fit.used_count > N ? std::sqrt(chi2 / (fit.used_count - N)) : 1.0;
        if (round + 1 < absolute_rounds || round + 1 == rounds) continue;
        const double scale = std::max(1.0, 1.4826 * median_of(sizes));
        for (std::size_t k = 0; k < offsets.size(); ++k) fit.used[k] = sizes[k] <= cut * scale;
    }
    return fit;
}

/// The factor by which a residual larger than chance widens an uncertainty; 1 as long as chi^2 / dof is
/// within three standard deviations of 1.
inline double widening(double excess, int degrees_of_freedom) {
    const double chance = 1.0 + 3.0 * std::sqrt(2.0 / std::max(1, degrees_of_freedom));
    return excess * excess > chance ? excess : 1.0;
}

}  // namespace fidservo::vision
