// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The normal equations of a fit with a few parameters, A x = b with A symmetric and positive.
#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace fidservo {

/// A = P^T L D L^T P (Cholesky with pivots; Golub & Van Loan, Matrix Computations, 4.4). Compiled once for
/// each of the sizes at the end of this file, since Eigen's templates take seconds to compile for each size.
template <int N>
class NormalFactor {
  public:
    using Vector = Eigen::Matrix<double, N, 1>;
    using Matrix = Eigen::Matrix<double, N, N>;

    /// @param normal  A; its upper triangle is not read
    explicit NormalFactor(const Matrix& normal);

    bool has_succeeded() const;  ///< A is finite and the factor exists
    bool is_positive() const;
    /// Estimated reciprocal condition number: 1 for the identity, 0 for a singular A.
    double reciprocal_condition() const;

    Vector solve(const Vector& right) const;  ///< A^-1 b
    Matrix inverse() const;  ///< A^-1: the parameters' covariance, for weights of 1 / variance

  private:
    Eigen::LDLT<Matrix> factor_;
};

extern template class NormalFactor<2>;
extern template class NormalFactor<3>;
extern template class NormalFactor<4>;
extern template class NormalFactor<5>;
extern template class NormalFactor<6>;

/// A^-1 b
template <int N>
Eigen::Matrix<double, N, 1> solve_normal(const Eigen::Matrix<double, N, N>& normal,
                                         const Eigen::Matrix<double, N, 1>& right) {
    return NormalFactor<N>(normal).solve(right);
}

}  // namespace fidservo
