// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/heater_residuals.h"

#include <algorithm>

#include <Eigen/Dense>
#include <ceres/dynamic_numeric_diff_cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

namespace fidservo::calib {

double number_of(const HeaterParameters& heater, int i) {
    const std::array<double, heater_numbers> all{heater.onset_V, heater.gain_degC_per_V, heater.heating_tau_s,
                                                 heater.cooling_tau_s, heater.ambient_degC};
    return all[static_cast<std::size_t>(i)];
}

bool solve_heater(const HeaterResiduals& residuals, const HeaterFree& is_free, bool onset_bounded,
                  HeaterVector& x) {
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::DynamicNumericDiffCostFunction<HeaterResiduals, ceres::CENTRAL> cost(&residuals,
                                                                                ceres::DO_NOT_TAKE_OWNERSHIP);
    cost.AddParameterBlock(heater_count);
    cost.SetNumResiduals(residuals.count());
    ceres::Problem problem(ownership);
    problem.AddResidualBlock(&cost, nullptr, x.data());
    std::vector<int> held;
    held.reserve(heater_numbers);
    for (int i = 0; i < heater_count; ++i) {
        constexpr double farthest = 30.0;
        problem.SetParameterLowerBound(x.data(), i, i == 0 && onset_bounded ? 0.0 : -farthest);
        problem.SetParameterUpperBound(x.data(), i, farthest);
        if (!is_free[static_cast<std::size_t>(i)]) held.push_back(i);
    }
    if (held.size() == heater_numbers) return true;
    if (!held.empty()) problem.SetManifold(x.data(), new ceres::SubsetManifold(heater_count, held));
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 100;
    options.function_tolerance = 1e-12;
    options.parameter_tolerance = 1e-10;
    options.gradient_tolerance = 1e-14;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return summary.IsSolutionUsable() && x.allFinite();
}

HeaterInfluences influences_at(const HeaterResiduals& residuals, const HeaterFree& is_free,
                               const HeaterVector& x) {
    constexpr double step = 1e-6;  // crosses hardly any of the kinks between the cells of the table
    constexpr double prior = 1e-8;
    Eigen::Matrix<double, Eigen::Dynamic, heater_count> jacobian(residuals.count(), heater_count);
    for (int i = 0; i < heater_count; ++i) {
        HeaterVector up = x, down = x;
        up(i) += step;
        down(i) -= step;
        jacobian.col(i) = (residuals.at(up) - residuals.at(down)) / (2.0 * step);
        if (!is_free[static_cast<std::size_t>(i)]) jacobian.col(i).setZero();
    }
    const Eigen::VectorXd residual = residuals.at(x);
    const double variance = std::max(residual.squaredNorm() / residuals.count(), 1e-300);
    Eigen::Matrix<double, heater_count, heater_count> information = jacobian.transpose() * jacobian;
    information.diagonal().array() += prior * variance;
    Eigen::Matrix<double, heater_count, heater_count> inverse = information.inverse();
    HeaterInfluences result{{}, {}, residuals.run_counts(), 0};
    for (int i = 0; i < heater_count; ++i) {
        result.fitted += is_free[static_cast<std::size_t>(i)] ? 1 : 0;
        if (is_free[static_cast<std::size_t>(i)]) continue;
        inverse.row(i).setZero();
        inverse.col(i).setZero();
    }
    result.claimed = variance * inverse;
    result.readings = -inverse * jacobian.transpose() * residual.asDiagonal();
    return result;
}

BatchVariance variance_along(const HeaterInfluences& influences, const HeaterVector& gradient) {
    std::vector<std::vector<double>> series;
    Eigen::Index begin = 0;
    for (const int count : influences.run_counts) {
        const Eigen::RowVectorXd along = gradient.transpose() * influences.readings.middleCols(begin, count);
        series.emplace_back(along.data(), along.data() + count);
        begin += count;
    }
    BatchVariance result = batch_variance(series, influences.fitted);
    result.variance = std::max(result.variance, gradient.dot(influences.claimed * gradient));
    return result;
}

HeaterVector parameter_stds(const HeaterInfluences& influences) {
    HeaterVector std;
    for (int i = 0; i < heater_count; ++i)
        std(i) = std::sqrt(std::max(0.0, variance_along(influences, HeaterVector::Unit(i)).variance));
    return std;
}

HeaterVector gradient_of(const HeaterScale& scale, const HeaterVector& x, int number) {
    constexpr double step = 1e-4;
    HeaterVector gradient;
    for (int i = 0; i < heater_count; ++i) {
        HeaterVector up = x, down = x;
        up(i) += step;
        down(i) -= step;
        gradient(i) = (number_of(scale.at(up.data()), number) - number_of(scale.at(down.data()), number)) /
                      (2.0 * step);
    }
    return gradient;
}

}  // namespace fidservo::calib
