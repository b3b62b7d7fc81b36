// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/dense.h"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

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

Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
    return a.colPivHouseholderQr().solve(b);
}

Eigen::MatrixXd inverse_of_gram(const Eigen::MatrixXd& a) {
    return (a.transpose() * a).inverse();
}

Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    // Of the cosine, above -1: their cross product is too short to turn about.
    constexpr double opposite = 1e-12;
    const double cosine = from.dot(to);
    if (cosine < -1.0 + opposite) {
        const Eigen::Vector3d across = from.unitOrthogonal();
        return {0.0, across.x(), across.y(), across.z()};
    }
    const double doubled = std::sqrt(2.0 * (1.0 + cosine));
    const Eigen::Vector3d axis = from.cross(to) / doubled;
    return {0.5 * doubled, axis.x(), axis.y(), axis.z()};
}

}  // namespace fidservo::calib
