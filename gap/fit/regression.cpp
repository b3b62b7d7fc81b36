// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/regression.h"

#include "core/parallel.h"
#include "gap/fit/minimum_norm.h"
#include "gap/fit/score.h"
#include "gap/numbers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <Eigen/Dense>

namespace fidservo::gap {
namespace {

/// The ridge is a share of the column's own diagonal element of the normal matrix, enough to determine
/// columns that are nearly collinear, plus a share of the mean diagonal element of its group, enough to
/// restrain columns that nearly vanish in the fitted half, such as those of places that it does not visit.
constexpr double own_ridge = 1e-3, group_ridge = 3e-3;

Eigen::MatrixXd gram_of(const Window& window, const Errors& errors, std::span<const Column> columns,
                        std::span<const Column> nuisances, double& count) {
    std::vector<std::size_t> rows;
    for (std::size_t row = window.begin; row < window.end; ++row)
        if (!std::isnan(errors[row])) rows.push_back(row);
    count = static_cast<double>(rows.size());
    const auto height = static_cast<Eigen::Index>(rows.size());
    const auto width = static_cast<Eigen::Index>(columns.size());
    Eigen::MatrixXd all(height, width + 1), unknown(height, static_cast<Eigen::Index>(nuisances.size()));
    for (Eigen::Index i = 0; i < height; ++i) {
        const std::size_t row = rows[static_cast<std::size_t>(i)];
        for (Eigen::Index k = 0; k < width; ++k) all(i, k) = columns[static_cast<std::size_t>(k)].values[row];
        all(i, width) = errors[row];
        for (Eigen::Index k = 0; k < unknown.cols(); ++k)
            unknown(i, k) = nuisances[static_cast<std::size_t>(k)].values[row];
    }
    const Eigen::MatrixXd full = all.transpose() * all;
    if (unknown.cols() == 0 || height <= unknown.cols()) return full;
    const Eigen::MatrixXd mixed = unknown.transpose() * all;
    const Eigen::MatrixXd own = unknown.transpose() * unknown;
    return full - mixed.transpose() * minimum_norm_solutions(own, mixed);
}

double square_of(const CondensedWindow& window, std::span<const Eigen::Index> columns,
                 const Eigen::VectorXd& factors) {
    const Eigen::Index last = window.gram.cols() - 1;
    double square = window.gram(last, last);
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const double factor = factors(static_cast<Eigen::Index>(i));
        square -= 2.0 * factor * window.gram(columns[i], last);
        for (std::size_t k = 0; k < columns.size(); ++k)
            square += factor * factors(static_cast<Eigen::Index>(k)) * window.gram(columns[i], columns[k]);
    }
    return std::max(0.0, square) / window.count;
}

/// Mean square after the projection that removes the nuisances.
double square_of(const CondensedWindow& window) {
    return window.gram(window.gram.rows() - 1, window.gram.cols() - 1) / window.count;
}

/// Drops windows that are wrong by orders of magnitude more than most wrong ones: the carriage stood where
/// the prediction moves, or moved where the prediction stands. Any column makes them a little less wrong; no
/// linear model explains them.
void drop_gross_windows(std::vector<CondensedWindow>& windows) {
    constexpr double wrong = off_square, ratio = 100.0;
    std::vector<double> squares;
    for (const CondensedWindow& window : windows)
        if (square_of(window) > wrong) squares.push_back(square_of(window));
    if (squares.empty()) return;
    const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
    std::ranges::nth_element(squares, middle);
    const double most = ratio * *middle;
    std::erase_if(windows, [&](const CondensedWindow& window) { return square_of(window) > most; });
}

}  // namespace

Regression::Regression(const std::vector<Window>& windows, Signal signal, const Errors& errors,
                       std::span<const Column> columns, std::span<const Column> nuisances,
                       std::span<const std::uint8_t> half)
    : windows_(windows) {
    for (const Column& column : columns) group_of_.push_back(column.group);
    for (std::size_t w = 0; w < windows.size(); ++w)
        if (windows[w].signal == signal) condensed_.push_back({w, half[w], 0.0, {}});
    parallel_for(condensed_.size(), [&](std::size_t k) {
        CondensedWindow& condensed = condensed_[k];
        condensed.gram = gram_of(windows[condensed.window], errors, columns, nuisances, condensed.count);
    });
    std::erase_if(condensed_, [](const CondensedWindow& condensed) { return condensed.count == 0.0; });
    drop_gross_windows(condensed_);
}

Eigen::VectorXd Regression::means_in_groups(std::span<const Eigen::Index> columns,
                                            const Eigen::VectorXd& values) const {
    const auto group = [&](Eigen::Index i) {
        return group_of_[static_cast<std::size_t>(columns[static_cast<std::size_t>(i)])];
    };
    std::map<int, std::pair<double, double>> sums;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
        sums[group(i)].first += values(i);
        sums[group(i)].second += 1.0;
    }
    return Eigen::VectorXd::NullaryExpr(values.size(), [&](Eigen::Index i) {
        const auto& [sum, count] = sums.at(group(i));
        return sum / count;
    });
}

Eigen::VectorXd Regression::solve(std::span<const Eigen::Index> columns, std::uint8_t half) const {
    if (columns.empty()) return {};
    const auto width = static_cast<Eigen::Index>(columns.size());
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(width, width);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(width);
    for (const CondensedWindow& window : condensed_) {
        if (window.half != half) continue;
        const Eigen::Index last = window.gram.cols() - 1;
        const double weight = 1.0 / (window.count + window.gram(last, last));
        for (Eigen::Index i = 0; i < width; ++i) {
            const Eigen::Index a = columns[static_cast<std::size_t>(i)];
            right(i) += weight * window.gram(a, last);
            for (Eigen::Index k = 0; k < width; ++k)
                normal(i, k) += weight * window.gram(a, columns[static_cast<std::size_t>(k)]);
        }
    }
    constexpr double relative_floor = 1e-12;
    const double floor = relative_floor * std::max(least_positive, normal.diagonal().maxCoeff());
    const Eigen::VectorXd own = normal.diagonal();
    normal.diagonal() += own_ridge * own + group_ridge * means_in_groups(columns, own) +
                         Eigen::VectorXd::Constant(width, floor);
    return normal.ldlt().solve(right);
}

std::vector<Eigen::Index> Regression::columns_of(std::span<const int> groups) const {
    std::vector<Eigen::Index> columns;
    for (const int group : groups)
        for (std::size_t k = 0; k < group_of_.size(); ++k)
            if (group_of_[k] == group) columns.push_back(static_cast<Eigen::Index>(k));
    return columns;
}

std::vector<double> Regression::factors(std::span<const int> groups) const {
    const std::vector<Eigen::Index> columns = columns_of(groups);
    if (columns.empty()) return {};
    const Eigen::VectorXd mean = 0.5 * (solve(columns, 0) + solve(columns, 1));
    return {mean.begin(), mean.end()};
}

Regression Regression::restricted_to(std::span<const std::uint8_t> kept) const {
    Regression some = *this;
    std::erase_if(some.condensed_, [&](const CondensedWindow& window) { return kept[window.window] == 0; });
    return some;
}

std::vector<double> Regression::mean_squares(std::span<const int> groups) const {
    std::vector<Eigen::Index> columns = columns_of(groups);
    std::ranges::sort(columns);
    const Eigen::VectorXd of_half[2] = {solve(columns, 0), solve(columns, 1)};
    std::vector<double> squares(windows_.size(), std::numeric_limits<double>::quiet_NaN());
    for (const CondensedWindow& window : condensed_)
        squares[window.window] = square_of(window, columns, of_half[1 - window.half]);
    return squares;
}

std::vector<int> Regression::significant_groups(double tail, double as_good) const {
    struct Trial {
        int group;
        Comparison comparison;
        std::vector<double> squares;
    };
    const std::set<int> all(group_of_.begin(), group_of_.end());
    std::vector<int> taken;
    std::vector<double> before = mean_squares(taken);
    int count = 0;
    for (;;) {
        std::vector<Trial> trials;
        for (const int group : all)
            if (std::ranges::find(taken, group) == taken.end()) trials.push_back({group, {}, {}});
        parallel_for(trials.size(), [&](std::size_t k) {
            std::vector<int> more = taken;
            more.push_back(trials[k].group);
            trials[k].squares = mean_squares(more);
            trials[k].comparison = compare(windows_, before, trials[k].squares);
        });
        count += static_cast<int>(trials.size());
        std::erase_if(trials, [&](const Trial& trial) {
            return trial.comparison.gain <= least_gain ||
                   trial.comparison.significance <= significance_bound(trial.comparison.blocks, count, tail);
        });
        if (trials.empty()) return taken;
        const auto gain = [](const Trial& trial) { return trial.comparison.gain; };
        const Trial best = *std::ranges::max_element(trials, {}, gain);
        std::erase_if(trials, [&](const Trial& trial) {
            return gain(trial) < as_good * gain(best) ||
                   compare(windows_, trial.squares, best.squares).significance > chance_stds;
        });
        const auto simplest = std::ranges::min_element(trials, {}, [&](const Trial& trial) {
            return std::pair(std::ranges::count(group_of_, trial.group), -gain(trial));
        });
        taken.push_back(simplest->group);
        before = std::move(simplest->squares);
    }
}

}  // namespace fidservo::gap
