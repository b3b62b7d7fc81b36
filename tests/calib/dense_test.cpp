// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/dense.h"

#include <numbers>

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

TEST(Dense, LeastSquares_FindsTheLineThroughPointsOnIt) {
    Eigen::MatrixXd a(4, 2);
    a << 1.0, 0.0, 1.0, 1.0, 1.0, 2.0, 1.0, 3.0;
    const Eigen::VectorXd found = least_squares(a, a * Eigen::Vector2d(-1.0, 0.5));
    EXPECT_LT((found - Eigen::Vector2d(-1.0, 0.5)).norm(), 1e-14);
    Eigen::Matrix2d gram;
    gram << 4.0, 6.0, 6.0, 14.0;
    EXPECT_LT((inverse_of_gram(a) * gram - Eigen::Matrix2d::Identity()).norm(), 1e-13);
}

TEST(Dense, TurnBetween_TakesTheOneToTheOtherByTheAngleBetweenThem) {
    for (const double angle_rad : {0.0, 1e-9, 0.3, 1.5, 3.0}) {
        const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
        const Eigen::Vector3d from = axis.unitOrthogonal();
        const Eigen::Vector3d to = Eigen::AngleAxisd(angle_rad, axis) * from;
        const Eigen::Quaterniond turn = turn_between(from, to);
        EXPECT_LT((turn * from - to).norm(), 1e-14) << angle_rad;
        EXPECT_NEAR(Eigen::AngleAxisd(turn).angle(), angle_rad, 1e-8) << angle_rad;
        EXPECT_LT((turn.coeffs() - Eigen::Quaterniond::FromTwoVectors(from, to).coeffs()).norm(), 1e-14);
    }
}

TEST(Dense, TurnBetweenOppositeOnes_IsHalfATurnAcrossThem) {
    const Eigen::Vector3d from = Eigen::Vector3d(0.6, 0.0, 0.8);
    const Eigen::Quaterniond turn = turn_between(from, -from);
    EXPECT_LT((turn * from + from).norm(), 1e-14);
    EXPECT_NEAR(Eigen::AngleAxisd(turn).angle(), std::numbers::pi, 1e-12);
}

}  // namespace
}  // namespace fidservo::calib
