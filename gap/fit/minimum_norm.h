// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Least squares where the data may not determine every unknown: of all x that minimise |A x - b|, the one of
// smallest norm, by a complete orthogonal decomposition (Golub & Van Loan, Matrix Computations, 5.5). The
// templates of Eigen are instantiated here only, since each instance takes seconds to compile.
#include <Eigen/Core>

namespace fidservo::gap {

Eigen::VectorXd minimum_norm_solution(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// The solutions for every column of b.
Eigen::MatrixXd minimum_norm_solutions(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The Moore-Penrose inverse A^+.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a);

}  // namespace fidservo::gap
