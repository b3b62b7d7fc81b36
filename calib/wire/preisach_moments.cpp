// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/preisach_moments.h"

#include "calib/nonnegative_least_squares.h"
#include "core/demand.h"

#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace fidservo::calib {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::size_t rows_at_once = 128;
constexpr double ridge = 1e-9;
constexpr double switched_share = 0.25;  ///< of a cell that must have switched for the data to know of it
constexpr double largest_error_share = 0.05;

Eigen::Map<const Eigen::VectorXd> vector(std::span<const double> values) {
    return {values.data(), static_cast<Eigen::Index>(values.size())};
}

Eigen::Map<RowMajor> square(std::vector<double>& values, std::size_t n) {
    return {values.data(), static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n)};
}

Eigen::Map<const RowMajor> square(std::span<const double> values, std::size_t n) {
    return {values.data(), static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n)};
}

/// Which cells make up each node (i, j): one row a node.
RowMajor node_sums(const PreisachGrid& grid) {
    const auto index = [](std::size_t i, std::size_t j) {
        return static_cast<Eigen::Index>(cell_index(i, j));
    };
    RowMajor sums = RowMajor::Zero(index(grid.nodes, 0), static_cast<Eigen::Index>(cell_count(grid)));
    for (std::size_t i = 0; i < grid.nodes; ++i)
        for (std::size_t j = 0; j <= i; ++j)
            for (std::size_t p = 0; p < i; ++p)
                for (std::size_t q = 0; q < j && q <= p; ++q) sums(index(i, j), index(p, q)) = 1.0;
    return sums;
}

}  // namespace

PreisachMoments::PreisachMoments(std::size_t cells)
    : share_sum_(cells, 0.0), product_sum_(cells, 0.0), matrix_(cells * cells, 0.0) {
    pending_.reserve(rows_at_once * cells);
}

void PreisachMoments::add(std::span<const double> shares, double output, double weight) {
    FIDSERVO_DEMAND(shares.size() == cells());
    samples_ += weight;
    output_sum_ += weight * output;
    output_squares_ += weight * output * output;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        share_sum_[i] += weight * shares[i];
        product_sum_[i] += weight * shares[i] * output;
        pending_.push_back(std::sqrt(weight) * shares[i]);
    }
    if (pending_.size() >= rows_at_once * cells()) flush();
}

void PreisachMoments::flush() const {
    const Eigen::Map<const RowMajor> rows(
        pending_.data(), static_cast<Eigen::Index>(pending_.size() / std::max<std::size_t>(cells(), 1)),
        static_cast<Eigen::Index>(cells()));
    square(matrix_, cells()).noalias() += rows.transpose() * rows;
    pending_.clear();
}

void PreisachMoments::add(const PreisachMoments& other) {
    FIDSERVO_DEMAND(other.cells() == cells());
    flush();
    other.flush();
    samples_ += other.samples_;
    output_sum_ += other.output_sum_;
    output_squares_ += other.output_squares_;
    for (std::size_t i = 0; i < cells(); ++i) {
        share_sum_[i] += other.share_sum_[i];
        product_sum_[i] += other.product_sum_[i];
    }
    for (std::size_t i = 0; i < matrix_.size(); ++i) matrix_[i] += other.matrix_[i];
}

std::vector<double> PreisachMoments::centred_matrix() const {
    flush();
    std::vector<double> centred = matrix_;
    const auto sum = vector(share_sum_);
    square(centred, cells()).noalias() -= sum * sum.transpose() / samples_;
    return centred;
}

std::vector<double> PreisachMoments::centred_rhs() const {
    std::vector<double> centred = product_sum_;
    for (std::size_t i = 0; i < centred.size(); ++i) centred[i] -= share_sum_[i] * mean_output();
    return centred;
}

double PreisachMoments::offset(std::span<const double> weights) const {
    return (output_sum_ - vector(share_sum_).dot(vector(weights))) / samples_;
}

double PreisachMoments::squares(std::span<const double> weights, double offset) const {
    flush();
    const auto w = vector(weights);
    const double model = w.dot(square(matrix_, cells()) * w) + 2.0 * offset * vector(share_sum_).dot(w) +
                         samples_ * offset * offset;
    return output_squares_ - 2.0 * (vector(product_sum_).dot(w) + offset * output_sum_) + model;
}

std::vector<double> roughness(const PreisachGrid& grid) {
    const std::size_t n = cell_count(grid);
    std::vector<double> rough(n * n, 0.0);
    const auto couple = [&](std::size_t a, std::size_t b) {
        rough[a * n + a] += 1.0;
        rough[b * n + b] += 1.0;
        rough[a * n + b] -= 1.0;
        rough[b * n + a] -= 1.0;
    };
    for (std::size_t p = 0; p + 1 < grid.nodes; ++p) {
        if (p > 0) couple(cell_index(p, p), cell_index(p - 1, p - 1));
        for (std::size_t q = 0; q < p; ++q) {
            if (q + 1 < p) couple(cell_index(p, q), cell_index(p, q + 1));
            if (q < p - 1) couple(cell_index(p, q), cell_index(p - 1, q));
        }
    }
    const double trace = square(rough, n).trace();
    if (trace > 0.0) square(rough, n) *= static_cast<double>(n) / trace;
    return rough;
}

std::vector<double> penalised_matrix(const PreisachMoments& moments, std::span<const double> rough,
                                     double penalty) {
    std::vector<double> matrix = moments.centred_matrix();
    auto g = square(matrix, moments.cells());
    const double scale = std::max(g.trace() / static_cast<double>(moments.cells()), 1e-300);
    g += penalty * scale * square(rough, moments.cells());
    g.diagonal().array() += ridge * scale;
    return matrix;
}

Result<std::vector<double>> fit_density(const PreisachMoments& moments, std::span<const double> rough,
                                        double penalty) {
    return nonnegative_least_squares(penalised_matrix(moments, rough, penalty), moments.centred_rhs());
}

std::vector<double> node_standard_errors(const PreisachGrid& grid, const PreisachMoments& moments,
                                         std::span<const double> weights, double variance) {
    std::vector<double> errors(grid.nodes * (grid.nodes + 1) / 2, 0.0);
    const auto w = vector(weights);
    const auto carrying = static_cast<double>((w.array() > 0.0).count());
    if (carrying == 0.0) return errors;
    const double scale_squared = w.squaredNorm() / carrying;
    std::vector<double> matrix = moments.centred_matrix();
    auto information = square(matrix, moments.cells());
    const double mean = information.trace() / static_cast<double>(moments.cells());
    information.diagonal().array() += std::max(variance / scale_squared, ridge * mean);
    const Eigen::LLT<Eigen::MatrixXd> factor(information);
    const Eigen::MatrixXd half = factor.matrixL().solve(node_sums(grid).transpose());
    for (std::size_t k = 0; k < errors.size(); ++k)
        errors[k] = std::sqrt(variance) * half.col(static_cast<Eigen::Index>(k)).norm();
    return errors;
}

std::vector<bool> determined_nodes(const PreisachGrid& grid, std::span<const double> least_share,
                                   std::span<const double> most_share, std::span<const double> node_std,
                                   double stroke) {
    std::vector<bool> switched(node_std.size(), true), determined(node_std.size(), true);
    for (std::size_t i = 1; i < grid.nodes; ++i)
        for (std::size_t j = 1; j <= i; ++j) {
            const std::size_t cell = cell_index(i - 1, j - 1), node = cell_index(i, j);
            const bool before =
                switched[cell_index(i, j - 1)] && switched[cell_index(i - 1, std::min(j, i - 1))];
            switched[node] = before && most_share[cell] - least_share[cell] >= switched_share;
            determined[node] = switched[node] && node_std[node] <= largest_error_share * stroke;
        }
    return determined;
}

}  // namespace fidservo::calib
