// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/minimum_norm.h"

#include <Eigen/QR>

namespace fidservo::gap {

Eigen::VectorXd minimum_norm_solution(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
    return a.completeOrthogonalDecomposition().solve(b);
}

Eigen::MatrixXd minimum_norm_solutions(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return a.completeOrthogonalDecomposition().solve(b);
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a) {
    return a.completeOrthogonalDecomposition().pseudoInverse();
}

}  // namespace fidservo::gap
