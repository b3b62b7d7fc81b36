// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/fit.h"

#include "core/parallel.h"
#include "gap/candidates/scaled_parameters.h"
#include "gap/fit/counted_rows.h"
#include "gap/fit/minimum_norm.h"
#include "gap/fit/score.h"
#include "gap/fit/slopes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Dense>
#include <ceres/ceres.h>

namespace fidservo::gap {
namespace {

/// A window condensed to what fits need. With its counted values e and their derivatives J at one point: the
/// number of values, the sum of squares of e, and the inner products of the columns (J, e).
struct WindowProducts {
    double count = 0.0;
    double squares = 0.0;
    Eigen::MatrixXd products;

    double mean_square() const { return count > 0.0 ? squares / count : 0.0; }
    auto gradient() const { return products.topRightCorner(products.rows() - 1, 1); }
    auto normal() const { return products.topLeftCorner(products.rows() - 1, products.cols() - 1); }
};

/// Errors and their derivatives at one point, computed once for all windows.
class Linearised : public ceres::EvaluationCallback {
  public:
    Linearised(const Predict& predict, const ScaledParameters& parameters, std::span<const Window> windows,
               const FitOptions& options)
        : predict_(predict), parameters_(parameters), windows_(windows), options_(options) {}

    void PrepareForEvaluation(bool with_derivatives, bool at_new_point) override {
        if (at_new_point && parameters_.values != values_) {
            values_ = parameters_.values;
            errors = predict_(parameters_.at(values_));
            has_derivatives_ = false;
            condense({});
        }
        if (!with_derivatives || has_derivatives_ || errors.empty()) return;
        if (!take_slopes_over()) find_slopes();
        use_slopes();
    }

    /// Computes the derivatives at the present point by differences, if they were only updated from those of
    /// another point.
    void differentiate() {
        if (errors.empty() || is_exact_) return;
        find_slopes();
        use_slopes();
    }

    /// The function that is minimised: the windows' loss, and the prior if there is one.
    double loss() const {
        const double scale = options_.scale_floors * options_.scale_floors;
        double sum = 0.0;
        for (const WindowProducts& window : condensed)
            sum += scale * window_loss(window.mean_square() / scale);
        if (options_.expected_sizes == 0.0) return sum;
        for (std::size_t k = 0; k < parameters_.size(); ++k) {
            const double size = parameters_.typical_sizes(k, parameters_.values[k]) / options_.expected_sizes;
            sum += 0.5 * scale * size * size;
        }
        return sum;
    }

    Errors errors;
    std::vector<WindowProducts> condensed;  ///< one for each window

  private:
    void find_slopes() {
        slopes_ = {values_, errors, std::vector<Errors>(parameters_.size())};
        parallel_for(parameters_.size(), [&](std::size_t k) {
            slopes_.by_parameter[k] = slope(predict_, parameters_, k, errors, options_.step_scales);
        });
        is_exact_ = true;
    }

    /// Returns false where no derivatives are known that predict how the errors have changed.
    bool take_slopes_over() {
        if (slopes_.by_parameter.empty() || !move_slopes(slopes_, values_, errors)) return false;
        is_exact_ = false;
        return true;
    }

    void use_slopes() {
        condense(slopes_.by_parameter);
        for (std::size_t k = 0; k < parameters_.size(); ++k)
            if (is_held(k)) let_go(k);
        has_derivatives_ = true;
        if (!options_.keeps_slopes) slopes_ = {};
    }

    void condense(const std::vector<Errors>& by_parameter) {
        condensed.assign(windows_.size(), {});
        if (errors.empty()) return;
        parallel_for(windows_.size(), [&](std::size_t w) {
            const Window& window = windows_[w];
            const std::size_t width = by_parameter.size() + 1;
            Eigen::MatrixXd rows(window.end - window.begin, width);
            Eigen::Index count = 0;
            for (std::size_t row = window.begin; row < window.end; ++row) {
                if (std::isnan(errors[row])) continue;
                for (std::size_t k = 0; k + 1 < width; ++k) {
                    const float change = by_parameter[k][row];
                    rows(count, static_cast<Eigen::Index>(k)) = std::isfinite(change) ? change : 0.0F;
                }
                rows(count++, static_cast<Eigen::Index>(width) - 1) =
                    std::isfinite(errors[row]) ? errors[row] : 0.0F;
            }
            WindowProducts& here = condensed[w];
            here.count = static_cast<double>(count);
            here.products = rows.topRows(count).transpose() * rows.topRows(count);
            here.squares = here.products(here.products.rows() - 1, here.products.cols() - 1);
        });
    }

    /// Whether a parameter is at a bound beyond which the loss would fall: the others are then fitted with
    /// this one held fixed.
    bool is_held(std::size_t k) const {
        if (!parameters_.at_bound(k)) return false;
        double slope_of_loss = 0.0;
        for (const WindowProducts& window : condensed)
            if (window.count > 0.0)
                slope_of_loss +=
                    window.gradient()(static_cast<Eigen::Index>(k), 0) /
                    (options_.scale_floors * options_.scale_floors * window.count + window.squares);
        const bool is_low = parameters_.values[k] <= parameters_.low(k);
        return is_low ? slope_of_loss > 0.0 : slope_of_loss < 0.0;
    }

    void let_go(std::size_t k) {
        for (WindowProducts& window : condensed) {
            window.products.row(static_cast<Eigen::Index>(k)).setZero();
            window.products.col(static_cast<Eigen::Index>(k)).setZero();
        }
    }

    const Predict& predict_;
    const ScaledParameters& parameters_;
    std::span<const Window> windows_;
    FitOptions options_;
    std::vector<double> values_;  ///< at which the errors were computed
    bool has_derivatives_ = false, is_exact_ = false;
    KnownSlopes slopes_;
};

/// A window as one residual for each parameter and one more: the triangular factor of its matrix of inner
/// products, divided by the number of values, so that the squared residuals sum to S_w.
class WindowErrors : public ceres::CostFunction {
  public:
    WindowErrors(const Linearised& at, std::size_t which, std::size_t parameters) : at_(at), which_(which) {
        mutable_parameter_block_sizes()->push_back(static_cast<int>(parameters));
        set_num_residuals(static_cast<int>(parameters) + 1);
    }

    bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
        if (at_.errors.empty()) return false;
        const WindowProducts& window = at_.condensed[which_];
        const Eigen::Index size = num_residuals(), width = size - 1;
        Eigen::Map<Eigen::VectorXd> left(residuals, size);
        left.setZero();
        if (jacobians == nullptr || jacobians[0] == nullptr) {
            left(0) = std::sqrt(window.mean_square());
            return true;
        }
        const Eigen::LDLT<Eigen::MatrixXd> factors(window.products / std::max(1.0, window.count));
        Eigen::MatrixXd upper = factors.transpositionsP() * Eigen::MatrixXd::Identity(size, size);
        upper = factors.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
                Eigen::MatrixXd(factors.matrixU() * upper);
        using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        Eigen::Map<RowMajor>(jacobians[0], size, width) = upper.leftCols(width);
        left = upper.col(width);
        return true;
    }

  private:
    const Linearised& at_;
    std::size_t which_;
};

/// The prior as residuals: the sizes' distances from zero effect in standard deviations, weighted as the
/// windows' losses are.
class ExpectedSizes : public ceres::CostFunction {
  public:
    ExpectedSizes(const ScaledParameters& parameters, const FitOptions& options)
        : parameters_(parameters), weight_(options.scale_floors / options.expected_sizes) {
        mutable_parameter_block_sizes()->push_back(static_cast<int>(parameters.size()));
        set_num_residuals(static_cast<int>(parameters.size()));
    }

    bool Evaluate(double const* const* values, double* residuals, double** jacobians) const override {
        const std::size_t size = parameters_.size();
        for (std::size_t k = 0; k < size; ++k)
            residuals[k] = weight_ * parameters_.typical_sizes(k, values[0][k]);
        if (jacobians == nullptr || jacobians[0] == nullptr) return true;
        std::fill_n(jacobians[0], size * size, 0.0);
        for (std::size_t k = 0; k < size; ++k)
            if (parameters_.typical_sizes(k, values[0][k] + 1.0) !=
                parameters_.typical_sizes(k, values[0][k]))
                jacobians[0][k * size + k] = weight_;
        return true;
    }

  private:
    const ScaledParameters& parameters_;
    double weight_;
};

/// The matrix of all parameters in their own units, from that of the free ones in scales; 0 for the others.
Eigen::MatrixXd of_all(const Eigen::MatrixXd& of_free, const std::vector<Eigen::Index>& free,
                       const ScaledParameters& parameters) {
    const auto all = static_cast<Eigen::Index>(parameters.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(all, all);
    for (Eigen::Index i = 0; i < of_free.rows(); ++i)
        for (Eigen::Index k = 0; k < of_free.cols(); ++k)
            matrix(free[i], free[k]) = of_free(i, k) * parameters.scale(static_cast<std::size_t>(free[i])) *
                                       parameters.scale(static_cast<std::size_t>(free[k]));
    return matrix;
}

/// Sets the covariances H^-1 (sum over windows of g g') H^-1 and, with the prior in H, H^-1: g are the
/// windows' gradients, H is the matrix of second derivatives. Parameters at their bounds count as known.
void find_covariances(const Linearised& at, const ScaledParameters& parameters, const FitOptions& options,
                      Fit& result) {
    std::vector<Eigen::Index> free;
    for (std::size_t k = 0; k < parameters.size(); ++k)
        if (!parameters.at_bound(k)) free.push_back(static_cast<Eigen::Index>(k));
    const auto width = static_cast<Eigen::Index>(free.size());
    if (width == 0) {
        const auto all = static_cast<Eigen::Index>(parameters.size());
        result.covariance = result.curvature_covariance = Eigen::MatrixXd::Zero(all, all);
        return;
    }
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(width, width), scatter = normal;
    for (const WindowProducts& window : at.condensed) {
        if (window.count == 0.0) continue;
        const Eigen::VectorXd gradient = window.gradient()(free, 0);
        const double weight = 1.0 / (window.count + window.squares);
        normal += weight * Eigen::MatrixXd(window.normal()(free, free));
        scatter += (weight * weight) * gradient * gradient.transpose();
    }
    const Eigen::MatrixXd inverse = pseudo_inverse(normal);
    result.covariance = of_all(inverse * scatter * inverse, free, parameters);
    if (options.expected_sizes > 0.0)
        for (Eigen::Index i = 0; i < width; ++i) {
            const auto k = static_cast<std::size_t>(free[i]);
            if (parameters.is_size(k))
                normal(i, i) += 1.0 / (options.expected_sizes * options.expected_sizes);
        }
    result.curvature_covariance = of_all(pseudo_inverse(normal), free, parameters);
}

}  // namespace

Fit fit(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
        const Hypothesis& start, const FitOptions& options) {
    constexpr double least_loss = 1.0;  // improvements are relative to the loss, or to this if it is less
    const CountedRows rows(windows, counted);
    const Predict predict_counted = [&](const Hypothesis& settings) { return rows.of(predict(settings)); };
    const Wanted all(rows.windows().size(), 1);
    ScaledParameters parameters(start);
    const std::vector<double> values_at_start = parameters.values;
    Linearised linearised(predict_counted, parameters, rows.windows(), options);
    linearised.PrepareForEvaluation(false, true);
    const auto size = static_cast<Eigen::Index>(parameters.size());
    const Eigen::MatrixXd unknown = Eigen::MatrixXd::Zero(size, size);
    Fit result{start, total_loss(rows.windows(), all, linearised.errors), unknown, unknown};
    if (parameters.size() == 0 || linearised.errors.empty()) return result;
    const double loss_at_start = linearised.loss();

    ceres::Problem::Options how;
    how.evaluation_callback = &linearised;
    // Ceres would not take a loss that no block uses.
    how.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::CauchyLoss loss(options.scale_floors);
    ceres::Problem problem(how);
    for (std::size_t c = 0; c < linearised.condensed.size(); ++c)
        if (linearised.condensed[c].count > 0.0)
            problem.AddResidualBlock(new WindowErrors(linearised, c, parameters.size()), &loss,
                                     parameters.values.data());
    if (problem.NumResidualBlocks() == 0) return result;
    if (options.expected_sizes > 0.0)
        problem.AddResidualBlock(new ExpectedSizes(parameters, options), nullptr, parameters.values.data());
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        problem.SetParameterLowerBound(parameters.values.data(), static_cast<int>(k), parameters.low(k));
        problem.SetParameterUpperBound(parameters.values.data(), static_cast<int>(k), parameters.high(k));
    }
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    solver.max_num_iterations = options.most_iterations;
    solver.function_tolerance =
        std::max(options.tolerance, options.least_improvement / std::max(loss_at_start, least_loss));
    solver.parameter_tolerance = std::min(options.tolerance, FitOptions{}.tolerance);
    // A step beyond a bound is cut, without a line search.
    solver.max_num_line_search_step_size_iterations = 0;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);

    linearised.PrepareForEvaluation(false, true);
    if (!linearised.errors.empty() && linearised.loss() < loss_at_start) {
        result.hypothesis = parameters.at(parameters.values);
        result.loss = total_loss(rows.windows(), all, linearised.errors);
    } else {
        parameters.values = values_at_start;
    }
    if (!options.with_covariance) return result;
    linearised.PrepareForEvaluation(true, true);
    linearised.differentiate();
    find_covariances(linearised, parameters, options, result);
    return result;
}

}  // namespace fidservo::gap
