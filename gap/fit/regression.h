// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Linear models of a signal's residuals, many at a time: every window is condensed to the inner products of
// its columns, from which any subset of the columns can be fitted on some windows and judged on others.
//
// In a window with regressor columns X, errors e and nuisance columns N (the response to its unknown initial
// state), A = (X, e) is projected onto the orthogonal complement of N. The inner products are then
//
//     G = A'A - A'N (N'N)^-1 N'A
#include "gap/evidence.h"
#include "gap/numbers.h"

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace fidservo::gap {

/// Shares of the best gain from which on a simpler group is as good: usually, and for forces and tags.
inline constexpr double usually_as_good = 0.8, nearly_as_good = 1.0 - hardly_any;

/// Values of a regressor, laid out like the errors of the windows concerned.
struct Column {
    int group;  ///< columns with the same number stand for one cause
    std::vector<float> values;
};

/// The inner products of a window's columns and errors.
struct CondensedWindow {
    std::size_t window;    ///< index in Evidence::windows()
    std::uint8_t half;     ///< 0 or 1 (gap/evidence/halves.h)
    double count;          ///< number of values
    Eigen::MatrixXd gram;  ///< the inner products G, of the columns first, then of the errors
};

/// Condensed windows of one signal. Windows whose errors are orders of magnitude larger than most are left
/// out.
class Regression {
  public:
    /// @param columns, nuisances  with one value for each error
    Regression(const std::vector<Window>& windows, Signal signal, const Errors& errors,
               std::span<const Column> columns, std::span<const Column> nuisances,
               std::span<const std::uint8_t> half);

    /// S_w of the condensed windows if the columns of some groups are fitted to the half that does not
    /// contain the window; NaN for the other windows. Without groups: S_w after the projection alone. Ridge
    /// regression with weights 1 / (1 + S_w), as in gap/fit/score.h.
    std::vector<double> mean_squares(std::span<const int> groups) const;

    /// Forward selection of the groups that improve held-out predictions significantly, in the order of
    /// selection; of groups with about the same gain the one with the fewest columns is selected.
    /// @param tail  significance level: probability of selecting any group if the errors depend on none
    /// @param as_good  gains above this fraction of the best gain count as equal to it, if the best one's
    /// lead is not significant
    std::vector<int> significant_groups(double tail, double as_good) const;

    /// Coefficients of the columns of some groups, group after group in the given order: the mean of those
    /// fitted to each half.
    std::vector<double> factors(std::span<const int> groups) const;

    /// The same regression, restricted to the windows that are kept.
    /// @param kept  a flag for each of Evidence::windows()
    Regression restricted_to(std::span<const std::uint8_t> kept) const;

  private:
    std::vector<Eigen::Index> columns_of(std::span<const int> groups) const;

    /// For each column, the mean of the values over the columns of its group.
    Eigen::VectorXd means_in_groups(std::span<const Eigen::Index> columns,
                                    const Eigen::VectorXd& values) const;
    Eigen::VectorXd solve(std::span<const Eigen::Index> columns, std::uint8_t half) const;

    std::vector<Window> windows_;
    std::vector<int> group_of_;
    std::vector<CondensedWindow> condensed_;
};

}  // namespace fidservo::gap
