// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Prediction errors to first order in the parameters: e + sum over k of x_k c_k, with c_k a change of the
// errors, such as a step of one parameter makes, and x_k the number of such steps (its share). The loss
// follows from the inner products of e and all c_k in each window, which are computed once.
#include "gap/evidence.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace fidservo::gap {

class LinearErrors {
  public:
    /// @param windows  must outlive this object
    /// @param errors   e, in floors; rows that are NaN do not count
    /// @param changes  as long as e each; values that are not finite count as 0
    LinearErrors(std::span<const Window> windows, const Errors& errors, std::vector<Errors> changes);

    /// The number of changes c_k.
    Eigen::Index size() const { return static_cast<Eigen::Index>(changes_.size()); }

    struct Optimum {
        Eigen::VectorXd shares;            ///< of the changes, then of the further ones
        std::vector<double> mean_squares;  ///< with these shares, for each window; NaN where none count
    };

    /// The shares that minimise the sum over the counted windows of (sum of squares) / (n + sum of squares of
    /// e), n the number of rows that count: the loss (gap/fit/score.h) to second order in its weights at e.
    /// @param counted  one flag for each window
    /// @param further  more changes, for this question alone
    Optimum optimum(const Wanted& counted, std::vector<Errors> further = {}) const;

  private:
    void leave_out_what_does_not_count(Errors& change) const;

    std::span<const Window> windows_;
    std::vector<bool> counts_;               ///< for each row
    Errors errors_;                          ///< 0 where a row does not count
    std::vector<Errors> changes_;            ///< likewise
    std::vector<double> numbers_;            ///< of rows that count, for each window
    std::vector<Eigen::MatrixXd> products_;  ///< of the changes and, last, e: for each window
};

}  // namespace fidservo::gap
