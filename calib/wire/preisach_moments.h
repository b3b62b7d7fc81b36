// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The sums that a penalised, non-negative Preisach fit needs, and the fit from them.
#include "calib/wire/preisach_grid.h"
#include "core/result.h"

#include <span>
#include <vector>

namespace fidservo::calib {

/// Sums over samples of weights, cell fractions (shares), output and their products.
class PreisachMoments {
  public:
    explicit PreisachMoments(std::size_t cells);

    void add(std::span<const double> shares, double output, double weight = 1.0);
    void add(const PreisachMoments& other);

    std::size_t cells() const { return share_sum_.size(); }
    double samples() const { return samples_; }
    double mean_output() const { return samples_ > 0.0 ? output_sum_ / samples_ : 0.0; }

    /// Covariances about the mean, for a fit with a free offset: n x n row by row, and n.
    std::vector<double> centred_matrix() const;
    std::vector<double> centred_rhs() const;

    /// The offset that fits best with these weights.
    double offset(std::span<const double> weights) const;

    /// Sum of squares of output - offset - shares * weights.
    double squares(std::span<const double> weights, double offset) const;

  private:
    void flush() const;

    double samples_ = 0.0, output_sum_ = 0.0, output_squares_ = 0.0;
    std::vector<double> share_sum_, product_sum_;
    mutable std::vector<double> matrix_;  ///< sum over samples of shares shares^T, row by row
    /// Rows not yet added to the matrix: adding many at once is cheaper.
    mutable std::vector<double> pending_;
};

/// The roughness matrix D^T D of differences between neighbouring cells, n x n row by row. Cells off the
/// diagonal of the Preisach plane have neighbours in both directions, cells on the diagonal only along it.
/// The matrix is scaled such that its diagonal elements have the mean 1.
std::vector<double> roughness(const PreisachGrid& grid);

/// The information matrix with the roughness penalty added; the penalty is relative to the mean information
/// of a cell. A ridge of 1e-9 gives cells that never switched the weight 0.
std::vector<double> penalised_matrix(const PreisachMoments& moments, std::span<const double> rough,
                                     double penalty);

/// The weights of the cells, none negative.
Result<std::vector<double>> fit_density(const PreisachMoments& moments, std::span<const double> rough,
                                        double penalty);

/// Standard errors of the table's nodes (lower triangle, row by row) for residuals of a given variance. They
/// are those of an unconstrained fit with a zero-mean prior for each cell, whose standard deviation is the
/// typical weight of the cells with non-zero weight. Penalty and non-negativity are not used, so that nodes
/// that only these determine have large errors.
std::vector<double> node_standard_errors(const PreisachGrid& grid, const PreisachMoments& moments,
                                         std::span<const double> weights, double variance);

/// Which nodes the data determine: all cells in a node's sum were seen to switch (by their least and largest
/// fraction over the data), and its standard error is below 5 % of the stroke.
std::vector<bool> determined_nodes(const PreisachGrid& grid, std::span<const double> least_share,
                                   std::span<const double> most_share, std::span<const double> node_std,
                                   double stroke);

}  // namespace fidservo::calib
