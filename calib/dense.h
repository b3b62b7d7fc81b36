#pragma once
// Algebra on dense matrices of any size. Every shape of factor makes the compiler write the general product
// and the eigenvalue iteration anew, at seconds each; here they are written once.
#include <Eigen/Core>

namespace fidservo::calib {

/// A B
Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// J C J^T: the covariance of what depends on numbers of covariance C by the Jacobian J.
Eigen::MatrixXd propagated(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& jacobian);

struct SymmetricParts {
    Eigen::VectorXd values;   ///< ascending
    Eigen::MatrixXd vectors;  ///< unit columns, in the order of the values
};

/// Eigenvalues and eigenvectors of a symmetric matrix; its upper triangle is not read.
SymmetricParts symmetric_parts(const Eigen::MatrixXd& matrix);

}  // namespace fidservo::calib
