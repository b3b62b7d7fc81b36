// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Algebra on dense matrices of any size. Every shape of factor makes the compiler write the general product
// and the eigenvalue iteration anew, at seconds each; here they are written once.
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace fidservo::calib {

/// A B
Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// J C J^T: the covariance of what depends on numbers of covariance C by the Jacobian J.
Eigen::MatrixXd propagated(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& jacobian);

/// x that minimises |A x - b|, A of full rank.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// (A^T A)^-1: the covariance of what least_squares() finds, for errors of unit variance.
Eigen::MatrixXd inverse_of_gram(const Eigen::MatrixXd& a);

/// The rotation that takes unit vector `from` to unit vector `to` by the smallest angle; of opposite ones, by
/// half a turn about any axis across them.
Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

struct SymmetricParts {
    Eigen::VectorXd values;   ///< ascending
    Eigen::MatrixXd vectors;  ///< unit columns, in the order of the values
};

/// Eigenvalues and eigenvectors of a symmetric matrix; its upper triangle is not read.
SymmetricParts symmetric_parts(const Eigen::MatrixXd& matrix);

}  // namespace fidservo::calib
