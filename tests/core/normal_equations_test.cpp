// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/normal_equations.h"

#include <algorithm>
#include <type_traits>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

template <class Size>
class NormalFactorOf : public ::testing::Test {};

using Sizes = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                               std::integral_constant<int, 4>, std::integral_constant<int, 5>,
                               std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(NormalFactorOf, Sizes);

/// 2 on the diagonal, -1 beside it: its inverse is min(i, j) (n + 1 - max(i, j)) / (n + 1), counted from 1.
template <int N>
Eigen::Matrix<double, N, N> second_difference() {
    Eigen::Matrix<double, N, N> matrix = 2.0 * Eigen::Matrix<double, N, N>::Identity();
    for (int i = 0; i + 1 < N; ++i) matrix(i, i + 1) = matrix(i + 1, i) = -1.0;
    return matrix;
}

TYPED_TEST(NormalFactorOf, SecondDifference_HasItsKnownInverse) {
    constexpr int n = TypeParam::value;
    const NormalFactor<n> factor(second_difference<n>());
    ASSERT_TRUE(factor.has_succeeded());
    EXPECT_TRUE(factor.is_positive());
    const auto inverse = factor.inverse();
    for (int i = 1; i <= n; ++i)
        for (int j = 1; j <= n; ++j)
            EXPECT_NEAR(inverse(i - 1, j - 1), std::min(i, j) * (n + 1.0 - std::max(i, j)) / (n + 1.0),
                        1e-14);
    const Eigen::Matrix<double, n, 1> x = Eigen::Matrix<double, n, 1>::LinSpaced(n, 1.0, n);
    EXPECT_LT((solve_normal<n>(second_difference<n>(), second_difference<n>() * x) - x).norm(), 1e-13);
}

TYPED_TEST(NormalFactorOf, UpperTriangle_IsNotRead) {
    constexpr int n = TypeParam::value;
    Eigen::Matrix<double, n, n> lower = second_difference<n>();
    lower(0, n - 1) = 1e6;
    const Eigen::Matrix<double, n, 1> right = Eigen::Matrix<double, n, 1>::Ones();
    EXPECT_EQ(solve_normal<n>(lower, right), solve_normal<n>(second_difference<n>(), right));
}

TYPED_TEST(NormalFactorOf, Singular_IsToldByItsCondition) {
    constexpr int n = TypeParam::value;
    const Eigen::Matrix<double, n, 1> row = Eigen::Matrix<double, n, 1>::LinSpaced(n, 1.0, 2.0);
    EXPECT_LT(NormalFactor<n>(row * row.transpose()).reciprocal_condition(), 1e-12);
    EXPECT_NEAR(NormalFactor<n>(Eigen::Matrix<double, n, n>::Identity()).reciprocal_condition(), 1.0, 1e-12);
    EXPECT_FALSE(NormalFactor<n>(-second_difference<n>()).is_positive());
}

}  // namespace
}  // namespace fidservo
