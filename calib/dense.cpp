#include "calib/dense.h"

#include <Eigen/Eigenvalues>

namespace fidservo::calib {

Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return a * b;
}

Eigen::MatrixXd propagated(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& jacobian) {
    return product(product(jacobian, covariance), jacobian.transpose());
}

SymmetricParts symmetric_parts(const Eigen::MatrixXd& matrix) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace fidservo::calib
