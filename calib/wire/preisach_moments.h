// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The sums that a penalised, non-negative Preisach fit needs, and the fit from them.
#include "calib/wire/preisach_grid.h"
#include "core/result.h"

#include <span>
#include <vector>

namespace fidservo::calib {

/// Sums over samples of weight, shares, output and their products.
class PreisachMoments {
  public:
    explicit PreisachMoments(std::size_t cells);

    void add(std::span<const double> shares, double output, double weight = 1.0);
    void add(const PreisachMoments& other);

    std::size_t cells() const { return share_sum_.size(); }
    double samples() const { return samples_; }
    double mean_output() const { return samples_ > 0.0 ? output_sum_ / samples_ : 0.0; }

    /// Covariances about the mean, which is what a free offset leaves: n x n row by row, and n.
    std::vector<double> centred_matrix() const;
    std::vector<double> centred_rhs() const;

    /// Offset that fits the weights best.
    double offset(std::span<const double> weights) const;

    /// Sum of squares of output - offset - shares * weights.
    double squares(std::span<const double> weights, double offset) const;

  private:
    void flush() const;

    double samples_ = 0.0, output_sum_ = 0.0, output_squares_ = 0.0;
    std::vector<double> share_sum_, product_sum_;
    mutable std::vector<double> matrix_;   ///< sum of shares shares', row by row
    mutable std::vector<double> pending_;  ///< rows not yet in the matrix: many at once are cheaper
};

/// Differences of neighbouring cells, squared: D'D, n x n row by row. Off the diagonal between neighbours in
/// either direction, on the diagonal along it; scaled to a mean of one on its diagonal.
std::vector<double> roughness(const PreisachGrid& grid);

/// The information matrix that a penalty relative to the mean information of a cell makes of the moments.
/// A ridge of 1e-9 keeps cells that never switched at zero.
std::vector<double> penalised_matrix(const PreisachMoments& moments, std::span<const double> rough,
                                     double penalty);

/// The weights, none negative.
Result<std::vector<double>> fit_density(const PreisachMoments& moments, std::span<const double> rough,
                                        double penalty);

/// Standard errors of the table's nodes (lower triangle, row by row) for residuals of a variance: of the
/// unconstrained fit with a prior of zero mean on each cell, as wide as the weights of the cells that carry
/// any are large. Neither the penalty nor the bound enters: what only they determine is not known.
std::vector<double> node_standard_errors(const PreisachGrid& grid, const PreisachMoments& moments,
                                         std::span<const double> weights, double variance);

/// Which nodes the data determine: all cells in a node's sum were seen to switch (least and most share of
/// each cell over the data), and its standard error is below 5 % of the stroke.
std::vector<bool> determined_nodes(const PreisachGrid& grid, std::span<const double> least_share,
                                   std::span<const double> most_share, std::span<const double> node_std,
                                   double stroke);

}  // namespace fidservo::calib
