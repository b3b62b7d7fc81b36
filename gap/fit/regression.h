// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Linear models of what is left of a signal, many at a time: every window is condensed to the inner products
// of its columns, from which any subset of the columns can be fitted on some windows and judged on others.
//
// In a window, with columns X, errors e and nuisances N (what an unknown state at its start would add), X and
// e are projected onto what N cannot explain: A = (X, e), G = A'A - A'N (N'N)^-1 N'A.
#include "gap/evidence.h"

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace fidservo::gap {

/// Values of a regressor, laid out like the errors of the windows concerned.
struct Column {
    int group;  ///< columns that stand for one cause
    std::vector<float> values;
};

/// A window in inner products.
struct CondensedWindow {
    std::size_t window;    ///< its place in Evidence::windows()
    std::uint8_t half;     ///< gap/search/selection.h
    double count;          ///< of values
    Eigen::MatrixXd gram;  ///< of the columns, then the errors
};

/// Windows whose errors are of another order of magnitude than most are left out.
class Regression {
  public:
    /// @param columns, nuisances  as long as the errors
    Regression(std::span<const Window> windows, Signal signal, const Errors& errors,
               std::span<const Column> columns, std::span<const Column> nuisances,
               std::span<const std::uint8_t> half);

    /// S_w of the windows condensed, with the columns of some groups fitted on the half that a window is not
    /// in; NaN elsewhere. Without groups: what the nuisances leave.
    /// Ridge regression, weights 1 / (1 + S_w) as in gap/fit/score.h.
    std::vector<double> mean_squares(std::span<const int> groups) const;

    /// Groups that make held-out predictions better beyond chance, in the order of what they add; of groups
    /// that add about as much, the one of fewest columns.
    /// @param tail     of taking in anything where there is nothing
    /// @param as_good  share of the best one's gain that is about as much, where its lead may be chance
    std::vector<int> significant_groups(double tail, double as_good) const;

    /// Factors of the columns of some groups, group after group in the order given, fitted on each half and
    /// averaged.
    std::vector<double> factors(std::span<const int> groups) const;

    /// The same for those windows alone that are kept.
    /// @param kept  a flag for each of Evidence::windows()
    Regression restricted_to(std::span<const std::uint8_t> kept) const;

  private:
    std::vector<Eigen::Index> columns_of(std::span<const int> groups) const;

    /// Of each column, the mean over the columns of its group.
    Eigen::VectorXd means_in_groups(std::span<const Eigen::Index> columns,
                                    const Eigen::VectorXd& values) const;
    Eigen::VectorXd solve(std::span<const Eigen::Index> columns, std::uint8_t half) const;

    std::span<const Window> windows_;
    std::vector<int> group_of_;
    std::vector<CondensedWindow> condensed_;
};

}  // namespace fidservo::gap
