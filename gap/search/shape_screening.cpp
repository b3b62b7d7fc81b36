// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/shape_screening.h"

#include "gap/evidence/parallel.h"
#include "gap/fit/minimum_norm.h"
#include "gap/fit/score.h"
#include "gap/fit/slopes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace fidservo::gap {
namespace {

/// Of the windows counted, a value of each: what its square weighs in the loss. 0 where nothing is counted.
class Weights {
  public:
    Weights(std::span<const Window> windows, const Wanted& counted, const Errors& errors, double scale_floors)
        : of_value_(errors.size(), 0.0F) {
        const std::vector<double> squares = mean_squares(windows, errors);
        for (std::size_t w = 0; w < windows.size(); ++w) {
            if (counted[w] == 0 || std::isnan(squares[w])) continue;
            const auto values = static_cast<double>(windows[w].end - windows[w].begin);
            const double weight = 1.0 / (values * (1.0 + squares[w] / (scale_floors * scale_floors)));
            for (std::size_t k = windows[w].begin; k < windows[w].end; ++k)
                if (!std::isnan(errors[k])) of_value_[k] = static_cast<float>(weight);
        }
    }

    /// Over values that both have.
    double product(const Errors& left, const Errors& right) const {
        double sum = 0.0;
        for (std::size_t k = 0; k < of_value_.size(); ++k) {
            if (of_value_[k] == 0.0F) continue;
            const double product = static_cast<double>(left[k]) * right[k];
            if (!std::isnan(product)) sum += static_cast<double>(of_value_[k]) * product;
        }
        return sum;
    }

  private:
    std::vector<float> of_value_;
};

/// Everything that is there already, as it may still change.
class Surrounding {
  public:
    Surrounding(const Predict& predict, const Hypothesis& others, const Errors& errors,
                const Weights& weights, double expected_sizes)
        : weights_(weights), errors_(errors) {
        const ScaledParameters parameters(others);
        slopes_.resize(parameters.size());
        parallel_for(slopes_.size(),
                     [&](std::size_t k) { slopes_[k] = slope(predict, parameters, k, errors, usual_step); });
        const auto count = static_cast<Eigen::Index>(slopes_.size());
        Eigen::MatrixXd normal(count, count);
        for (Eigen::Index row = 0; row < count; ++row)
            for (Eigen::Index column = 0; column <= row; ++column)
                normal(row, column) = normal(column, row) = weights_.product(
                    slopes_[static_cast<std::size_t>(row)], slopes_[static_cast<std::size_t>(column)]);
        for (std::size_t k = 0; k < slopes_.size(); ++k)
            if (parameters.is_size(k)) {
                const auto at = static_cast<Eigen::Index>(k);
                normal(at, at) += 1.0 / (expected_sizes * expected_sizes);
            }
        inverse_ = count > 0 ? pseudo_inverse(normal) : normal;
        left_ = products_with(errors_);
    }

    /// Slope and curvature of the loss along a further column, of which a few typical sizes are expected,
    /// with everything else at its best.
    std::pair<double, double> slope_and_curvature(const Errors& column, double expected_sizes) const {
        const Eigen::VectorXd shared = products_with(column);
        return {weights_.product(column, errors_) - shared.dot(inverse_ * left_),
                weights_.product(column, column) + 1.0 / (expected_sizes * expected_sizes) -
                    shared.dot(inverse_ * shared)};
    }

  private:
    Eigen::VectorXd products_with(const Errors& column) const {
        Eigen::VectorXd products(static_cast<Eigen::Index>(slopes_.size()));
        for (std::size_t k = 0; k < slopes_.size(); ++k)
            products(static_cast<Eigen::Index>(k)) = weights_.product(slopes_[k], column);
        return products;
    }

    const Weights& weights_;
    const Errors& errors_;
    std::vector<Errors> slopes_;
    Eigen::MatrixXd inverse_;
    Eigen::VectorXd left_;
};

/// The nearest number of typical sizes that a rig can have.
double within_bounds(const Candidate& candidate, const std::vector<double>& shape, double typical_sizes) {
    for (const std::size_t k : candidate.sizes) {
        const plant::EffectParameter& parameter = candidate.effect->parameters[k];
        const double typical = shape[k] - parameter.vanishing;
        const auto [low, high] = std::minmax({(parameter.low - parameter.vanishing) / typical,
                                              (parameter.high - parameter.vanishing) / typical});
        typical_sizes = std::clamp(typical_sizes, low, high);
    }
    return typical_sizes;
}

}  // namespace

bool has_a_shape(const Candidate& candidate) {
    return std::ranges::any_of(candidate.effect->parameters, [](const plant::EffectParameter& parameter) {
        return !parameter.is_size() && !parameter.is_choice() && parameter.role != plant::Role::optional;
    });
}

plant::EffectSetting of_size(const Candidate& candidate, const std::vector<double>& shape,
                             double typical_sizes) {
    plant::EffectSetting setting{candidate.effect, shape};
    for (const std::size_t k : candidate.sizes) {
        const plant::EffectParameter& parameter = candidate.effect->parameters[k];
        setting.values[k] = std::clamp(parameter.vanishing + typical_sizes * (shape[k] - parameter.vanishing),
                                       parameter.low, parameter.high);
    }
    return setting;
}

std::vector<GridPoint> grid_of(std::span<const Candidate* const> candidates) {
    std::vector<GridPoint> grid;
    for (const Candidate* candidate : candidates)
        for (const std::vector<double>& shape : candidate->shapes) grid.push_back({candidate, shape});
    return grid;
}

std::vector<ScreenedShape> screened_shapes(const Predict& predict, std::span<const Window> windows,
                                           const Wanted& counted, const Hypothesis& others,
                                           std::span<const GridPoint> grid, double scale_floors,
                                           double expected_sizes) {
    constexpr double step = 0.05;  // typical sizes: small for the errors to change evenly, above what rounds
    const Errors errors = predict(others);
    if (errors.empty()) return {};
    const Weights weights(windows, counted, errors, scale_floors);
    const Surrounding surrounding(predict, others, errors, weights, expected_sizes);
    std::vector<ScreenedShape> screened(grid.size());
    parallel_for(grid.size(), [&](std::size_t k) {
        const auto& [candidate, shape] = grid[k];
        screened[k] = {candidate, {}, 0.0};
        Hypothesis with = others;
        with.push_back(of_size(*candidate, shape, step));
        Errors column = predict(with);
        if (column.empty()) return;
        for (std::size_t i = 0; i < column.size(); ++i)
            column[i] = (column[i] - errors[i]) / static_cast<float>(step);
        const auto [slope_of_loss, curvature] = surrounding.slope_and_curvature(column, expected_sizes);
        if (!(curvature > 0.0)) return;
        const double size = within_bounds(*candidate, shape, -slope_of_loss / curvature);
        screened[k].setting = of_size(*candidate, shape, size);
        screened[k].gain = -size * (slope_of_loss + 0.5 * curvature * size);
    });
    std::ranges::stable_sort(screened, std::greater{}, &ScreenedShape::gain);
    std::vector<ScreenedShape> best;
    for (ScreenedShape& one : screened)
        if (one.gain > 0.0 && std::ranges::find(best, one.candidate, &ScreenedShape::candidate) == best.end())
            best.push_back(std::move(one));
    return best;
}

}  // namespace fidservo::gap
