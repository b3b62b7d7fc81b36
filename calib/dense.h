// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Linear algebra on dense matrices of any size. Each function is compiled once here, since the compiler takes
// seconds for every type of product and eigenvalue iteration.
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace fidservo::calib {

/// A B
Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// J C J^T: the covariance of quantities that depend, with the Jacobian J, on numbers of covariance C.
Eigen::MatrixXd propagated(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& jacobian);

/// x that minimises |A x - b|, A of full rank.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// (A^T A)^-1: the covariance of the result of least_squares() for errors of unit variance.
Eigen::MatrixXd inverse_of_gram(const Eigen::MatrixXd& a);

/// The rotation by the smallest angle that maps the unit vector `from` to the unit vector `to`; for opposite
/// vectors, half a turn about some axis at right angles to them.
Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

struct SymmetricParts {
    Eigen::VectorXd values;   ///< ascending
    Eigen::MatrixXd vectors;  ///< unit columns, in the order of the values
};

/// Eigenvalues and eigenvectors of a symmetric matrix; its upper triangle is not read.
SymmetricParts symmetric_parts(const Eigen::MatrixXd& matrix);

}  // namespace fidservo::calib
