#include "gap/fit.h"

#include "gap/minimum_norm.h"
#include "gap/parallel.h"
#include "gap/scaled_parameters.h"
#include "gap/score.h"
#include "gap/slopes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <ceres/ceres.h>

namespace fidservo::gap {
namespace {

/// Errors and their derivatives at one point, computed once for all windows.
class Linearised : public ceres::EvaluationCallback {
  public:
    Linearised(const Predict& predict, const ScaledParameters& parameters, std::span<const Window> windows,
               const Wanted& counted, const FitOptions& options)
        : predict_(predict),
          parameters_(parameters),
          windows_(windows),
          counted_(counted),
          options_(options) {}

    void PrepareForEvaluation(bool with_derivatives, bool at_new_point) override {
        if (at_new_point && parameters_.values != values_) {
            values_ = parameters_.values;
            errors = predict_(parameters_.at(values_));
            has_derivatives_ = false;
        }
        if (!with_derivatives || has_derivatives_ || errors.empty()) return;
        by_parameter.assign(parameters_.size(), {});
        parallel_for(parameters_.size(), [this](std::size_t k) {
            by_parameter[k] = slope(predict_, parameters_, k, errors, options_.step_scales);
        });
        for (std::size_t k = 0; k < parameters_.size(); ++k)
            if (is_held(k)) std::ranges::fill(by_parameter[k], 0.0F);
        has_derivatives_ = true;
    }

    Errors errors;
    std::vector<Errors> by_parameter;

  private:
    /// Whether a parameter is at a bound and the loss falls beyond it: there the others are fitted as if it
    /// were known.
    bool is_held(std::size_t k) const {
        if (!parameters_.at_bound(k)) return false;
        double slope_of_loss = 0.0;
        for (std::size_t w = 0; w < windows_.size(); ++w) {
            if (counted_[w] == 0) continue;
            double squares = 0.0, product = 0.0, count = 0.0;
            for (std::size_t row = windows_[w].begin; row < windows_[w].end; ++row) {
                const double error = errors[row], change = by_parameter[k][row];
                if (std::isnan(error) || !std::isfinite(change)) continue;
                squares += error * error;
                product += error * change;
                count += 1.0;
            }
            if (count > 0.0) slope_of_loss += product / (count + squares);
        }
        const bool is_low = parameters_.values[k] <= parameters_.low(k);
        return is_low ? slope_of_loss > 0.0 : slope_of_loss < 0.0;
    }

    const Predict& predict_;
    const ScaledParameters& parameters_;
    std::span<const Window> windows_;
    const Wanted& counted_;
    FitOptions options_;
    std::vector<double> values_;  ///< that errors are of
    bool has_derivatives_ = false;
};

/// The values of a window that count, over the root of their number: the sum of their squares is S_w.
class WindowErrors : public ceres::CostFunction {
  public:
    WindowErrors(const Linearised& at, std::vector<std::size_t> rows, int parameters)
        : at_(at), rows_(std::move(rows)), share_(1.0 / std::sqrt(static_cast<double>(rows_.size()))) {
        mutable_parameter_block_sizes()->push_back(parameters);
        set_num_residuals(static_cast<int>(rows_.size()));
    }

    bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
        if (at_.errors.empty()) return false;
        for (std::size_t i = 0; i < rows_.size(); ++i) residuals[i] = share_ * value(at_.errors, i);
        if (jacobians == nullptr || jacobians[0] == nullptr) return true;
        const std::size_t width = at_.by_parameter.size();
        for (std::size_t i = 0; i < rows_.size(); ++i)
            for (std::size_t k = 0; k < width; ++k)
                jacobians[0][i * width + k] = share_ * value(at_.by_parameter[k], i);
        return true;
    }

  private:
    double value(const Errors& errors, std::size_t i) const {
        const float value = errors[rows_[i]];
        return std::isfinite(value) ? value : 0.0;
    }

    const Linearised& at_;
    std::vector<std::size_t> rows_;
    double share_;
};

std::vector<std::size_t> counted_rows(const Window& window, const Errors& errors) {
    std::vector<std::size_t> rows;
    for (std::size_t k = window.begin; k < window.end; ++k)
        if (!std::isnan(errors[k])) rows.push_back(k);
    return rows;
}

/// H^-1 (sum of g g') H^-1 over windows; parameters at their bounds count as known.
Eigen::MatrixXd sandwich(const Linearised& at, std::span<const Window> windows, const Wanted& counted,
                         const ScaledParameters& parameters) {
    std::vector<std::size_t> free;
    for (std::size_t k = 0; k < parameters.size(); ++k)
        if (!parameters.at_bound(k)) free.push_back(k);
    const auto width = static_cast<Eigen::Index>(free.size());
    const auto all = static_cast<Eigen::Index>(parameters.size());
    if (width == 0) return Eigen::MatrixXd::Zero(all, all);
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(width, width), scatter = normal;
    for (std::size_t w = 0; w < windows.size(); ++w) {
        if (counted[w] == 0) continue;
        const std::vector<std::size_t> rows = counted_rows(windows[w], at.errors);
        if (rows.empty()) continue;
        Eigen::VectorXd gradient = Eigen::VectorXd::Zero(width), slope(width);
        Eigen::MatrixXd own = Eigen::MatrixXd::Zero(width, width);
        double squares = 0.0;
        for (const std::size_t row : rows) {
            const double error = at.errors[row];
            for (Eigen::Index k = 0; k < width; ++k)
                slope(k) = at.by_parameter[free[static_cast<std::size_t>(k)]][row];
            gradient += error * slope;
            own += slope * slope.transpose();
            squares += error * error;
        }
        const double weight = 1.0 / (static_cast<double>(rows.size()) + squares);
        normal += weight * own;
        scatter += (weight * weight) * gradient * gradient.transpose();
    }
    const Eigen::MatrixXd inverse = pseudo_inverse(normal);
    const Eigen::MatrixXd of_free = inverse * scatter * inverse;
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(all, all);
    for (Eigen::Index i = 0; i < width; ++i)
        for (Eigen::Index k = 0; k < width; ++k) {
            const std::size_t a = free[static_cast<std::size_t>(i)], b = free[static_cast<std::size_t>(k)];
            covariance(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) =
                of_free(i, k) * parameters.scale(a) * parameters.scale(b);
        }
    return covariance;
}

}  // namespace

Fit fit(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
        const Hypothesis& start, const FitOptions& options) {
    ScaledParameters parameters(start);
    const std::vector<double> values_at_start = parameters.values;
    Linearised linearised(predict, parameters, windows, counted, options);
    linearised.PrepareForEvaluation(false, true);
    const auto size = static_cast<Eigen::Index>(parameters.size());
    Fit result{start, total_loss(windows, counted, linearised.errors), Eigen::MatrixXd::Zero(size, size)};
    if (parameters.size() == 0 || linearised.errors.empty()) return result;

    ceres::Problem::Options how;
    how.evaluation_callback = &linearised;
    how.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;  // it takes none of what no block uses
    ceres::CauchyLoss loss(1.0);
    ceres::Problem problem(how);
    for (std::size_t w = 0; w < windows.size(); ++w) {
        if (counted[w] == 0) continue;
        std::vector<std::size_t> rows = counted_rows(windows[w], linearised.errors);
        if (rows.empty()) continue;
        problem.AddResidualBlock(
            new WindowErrors(linearised, std::move(rows), static_cast<int>(parameters.size())), &loss,
            parameters.values.data());
    }
    if (problem.NumResidualBlocks() == 0) return result;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        problem.SetParameterLowerBound(parameters.values.data(), static_cast<int>(k), parameters.low(k));
        problem.SetParameterUpperBound(parameters.values.data(), static_cast<int>(k), parameters.high(k));
    }
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    solver.max_num_iterations = options.most_iterations;
    solver.function_tolerance = options.tolerance;
    solver.parameter_tolerance = options.tolerance;
    solver.max_num_line_search_step_size_iterations = 0;  // a step beyond a bound is cut, no more
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);

    linearised.PrepareForEvaluation(false, true);
    const double loss_there = total_loss(windows, counted, linearised.errors);
    if (loss_there < result.loss) {
        result.hypothesis = parameters.at(parameters.values);
        result.loss = loss_there;
    } else {
        parameters.values = values_at_start;
    }
    if (!options.with_covariance) return result;
    linearised.PrepareForEvaluation(true, true);
    result.covariance = sandwich(linearised, windows, counted, parameters);
    return result;
}

}  // namespace fidservo::gap
