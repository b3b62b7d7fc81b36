// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/starts/shape_screening.h"

#include "core/parallel.h"
#include "gap/fit/minimum_norm.h"
#include "gap/fit/score.h"
#include "gap/fit/slopes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace fidservo::gap {
namespace {

using WeightedErrors = Eigen::VectorXf;

/// Selects the values that count, each multiplied by the root of the weight that its square has in the loss.
class Weighting {
  public:
    Weighting(std::span<const Window> windows, const Wanted& counted, const Errors& errors,
              double scale_floors) {
        const std::vector<double> squares = mean_squares(windows, errors);
        for (std::size_t w = 0; w < windows.size(); ++w) {
            if (counted[w] == 0 || std::isnan(squares[w])) continue;
            const auto values = static_cast<double>(windows[w].end - windows[w].begin);
            const double weight = 1.0 / (values * (1.0 + squares[w] / (scale_floors * scale_floors)));
            for (std::size_t k = windows[w].begin; k < windows[w].end; ++k) {
                if (std::isnan(errors[k])) continue;
                at_.push_back(k);
                root_.push_back(static_cast<float>(std::sqrt(weight)));
            }
        }
    }

    /// Unknown values (NaN) have no weight.
    WeightedErrors weighted(const Errors& errors) const {
        WeightedErrors column(static_cast<Eigen::Index>(at_.size()));
        for (std::size_t i = 0; i < at_.size(); ++i) {
            const float error = errors[at_[i]];
            column(static_cast<Eigen::Index>(i)) = std::isnan(error) ? 0.0F : root_[i] * error;
        }
        return column;
    }

  private:
    std::vector<std::size_t> at_;
    std::vector<float> root_;
};

double product(const WeightedErrors& left, const WeightedErrors& right) {
    return left.cast<double>().dot(right.cast<double>());
}

/// The change of errors with a size, with its inner products.
struct SizeColumn {
    WeightedErrors change;
    Eigen::VectorXd with_others;  ///< with the changes by what is already there
    double with_errors = 0.0, square = 0.0;
};

/// The settings that are already there, whose parameters may still change.
class Surrounding {
  public:
    Surrounding(const Predict& predict, const Hypothesis& others, const Errors& errors,
                const Weighting& weighting, double expected_sizes)
        : prior_(1.0 / (expected_sizes * expected_sizes)), errors_(weighting.weighted(errors)) {
        const ScaledParameters parameters(others);
        slopes_.resize(parameters.size());
        parallel_for(slopes_.size(), [&](std::size_t k) {
            slopes_[k] = weighting.weighted(slope(predict, parameters, k, errors, usual_step));
        });
        const auto count = static_cast<Eigen::Index>(slopes_.size());
        normal_.resize(count, count);
        for (Eigen::Index row = 0; row < count; ++row)
            for (Eigen::Index column = 0; column <= row; ++column)
                normal_(row, column) = normal_(column, row) = product(
                    slopes_[static_cast<std::size_t>(row)], slopes_[static_cast<std::size_t>(column)]);
        for (std::size_t k = 0; k < slopes_.size(); ++k)
            if (parameters.is_size(k)) {
                const auto at = static_cast<Eigen::Index>(k);
                normal_(at, at) += prior_;
            }
        left_ = products_with(errors_);
        invert();
    }

    SizeColumn column_of(WeightedErrors change) const {
        SizeColumn column{{}, products_with(change), product(change, errors_), product(change, change)};
        column.change = std::move(change);
        return column;
    }

    /// Adds a column, whose size may change from then on.
    void add(const SizeColumn& column) {
        const Eigen::Index count = normal_.rows();
        normal_.conservativeResize(count + 1, count + 1);
        normal_.topRightCorner(count, 1) = column.with_others;
        normal_.bottomLeftCorner(1, count) = column.with_others.transpose();
        normal_(count, count) = column.square + prior_;
        left_.conservativeResize(count + 1);
        left_(count) = column.with_errors;
        slopes_.push_back(column.change);
        invert();
    }

    /// Slope and curvature of the loss along a further column, if all other parameters follow at their best;
    /// the curvature includes the column's own prior.
    /// @param column  receives its products with columns that were added since the last call
    std::pair<double, double> slope_and_curvature(SizeColumn& column) const {
        Eigen::VectorXd& shared = column.with_others;
        const Eigen::Index known = shared.size(), count = normal_.rows();
        shared.conservativeResize(count);
        for (Eigen::Index k = known; k < count; ++k)
            shared(k) = product(slopes_[static_cast<std::size_t>(k)], column.change);
        return {column.with_errors - shared.dot(inverse_ * left_),
                column.square + prior_ - shared.dot(inverse_ * shared)};
    }

  private:
    void invert() { inverse_ = normal_.rows() > 0 ? pseudo_inverse(normal_) : normal_; }

    Eigen::VectorXd products_with(const WeightedErrors& column) const {
        Eigen::VectorXd products(static_cast<Eigen::Index>(slopes_.size()));
        for (std::size_t k = 0; k < slopes_.size(); ++k)
            products(static_cast<Eigen::Index>(k)) = product(slopes_[k], column);
        return products;
    }

    double prior_;
    WeightedErrors errors_;
    std::vector<WeightedErrors> slopes_;
    Eigen::MatrixXd normal_, inverse_;
    Eigen::VectorXd left_;
};

/// The number of typical sizes, limited to what the parameters' bounds allow.
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
    // Typical sizes: small enough for a linear response, large enough against rounding.
    constexpr double step = 0.05;
    const Errors errors = predict(others);
    if (errors.empty()) return {};
    const Weighting weighting(windows, counted, errors, scale_floors);
    Surrounding surrounding(predict, others, errors, weighting, expected_sizes);
    std::vector<SizeColumn> columns(grid.size());
    parallel_for(grid.size(), [&](std::size_t k) {
        Hypothesis with = others;
        with.push_back(of_size(*grid[k].candidate, grid[k].shape, step));
        Errors column = predict(with);
        if (column.empty()) return;
        for (std::size_t i = 0; i < column.size(); ++i)
            column[i] = (column[i] - errors[i]) / static_cast<float>(step);
        columns[k] = surrounding.column_of(weighting.weighted(column));
    });
    std::vector<ScreenedShape> found;
    while (true) {
        std::vector<ScreenedShape> screened(grid.size());
        parallel_for(grid.size(), [&](std::size_t k) {
            const auto& [candidate, shape] = grid[k];
            screened[k] = {candidate, {}, 0.0};
            const bool is_found =
                std::ranges::find(found, candidate, &ScreenedShape::candidate) != found.end();
            if (is_found || columns[k].change.size() == 0) return;
            const auto [slope_of_loss, curvature] = surrounding.slope_and_curvature(columns[k]);
            if (!(curvature > 0.0)) return;
            const double size = within_bounds(*candidate, shape, -slope_of_loss / curvature);
            screened[k].setting = of_size(*candidate, shape, size);
            screened[k].gain = -size * (slope_of_loss + 0.5 * curvature * size);
        });
        const auto best = std::ranges::max_element(screened, {}, &ScreenedShape::gain);
        if (best == screened.end() || !(best->gain > 0.0)) return found;
        surrounding.add(columns[static_cast<std::size_t>(best - screened.begin())]);
        found.push_back(std::move(*best));
    }
}

}  // namespace fidservo::gap
