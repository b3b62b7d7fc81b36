// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/minimum_norm.h"

#include <gtest/gtest.h>

namespace fidservo::gap {
namespace {

/// Of rank 1: a a^T.
Eigen::MatrixXd rank_one(const Eigen::VectorXd& a) {
    return a * a.transpose();
}

TEST(MinimumNorm, SolvableButUndetermined_IsTheShortestSolution) {
    const Eigen::VectorXd a = Eigen::Vector3d(1.0, 2.0, 2.0);
    const Eigen::VectorXd x = minimum_norm_solution(rank_one(a), 9.0 * a);
    EXPECT_LT((x - a).norm(), 1e-12);  // a (a.x) = 9 a has every x with a.x = 9; the shortest is 9 a / |a|^2
}

TEST(MinimumNorm, Determined_IsTheSolution) {
    Eigen::Matrix2d matrix;
    matrix << 2.0, 1.0, 1.0, 3.0;
    const Eigen::VectorXd x = minimum_norm_solution(matrix, Eigen::Vector2d(5.0, 10.0));
    EXPECT_LT((x - Eigen::Vector2d(1.0, 3.0)).norm(), 1e-13);
}

TEST(MinimumNorm, SeveralRightSides_AreSolvedEachByItself) {
    const Eigen::VectorXd a = Eigen::Vector3d(1.0, 2.0, 2.0);
    Eigen::MatrixXd right(3, 2);
    right << 9.0 * a, 18.0 * a;
    const Eigen::MatrixXd x = minimum_norm_solutions(rank_one(a), right);
    EXPECT_LT((x.col(0) - a).norm(), 1e-12);
    EXPECT_LT((x.col(1) - 2.0 * a).norm(), 1e-12);
}

TEST(PseudoInverse, OfRankOne_IsItselfOverTheFourthPower) {
    const Eigen::VectorXd a = Eigen::Vector3d(1.0, 2.0, 2.0);
    EXPECT_LT((pseudo_inverse(rank_one(a)) - rank_one(a) / 81.0).norm(), 1e-13);
}

}  // namespace
}  // namespace fidservo::gap
