// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Least squares where the data may not determine every unknown: of all solutions of A x = b, or of what comes
// nearest to one, the shortest, by a complete orthogonal decomposition (Golub & Van Loan, Matrix
// Computations, 5.5). Compiled once: Eigen's templates take seconds wherever they are written out.
#include <Eigen/Core>

namespace fidservo::gap {

Eigen::VectorXd minimum_norm_solution(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// Of every column of b.
Eigen::MatrixXd minimum_norm_solutions(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// A^+, of Moore and Penrose.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a);

}  // namespace fidservo::gap
