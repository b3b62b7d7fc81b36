// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/nonnegative_least_squares.h"

#include "core/failure.h"
#include "core/random.h"
#include "core/result.h"

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

TEST(NonnegativeLeastSquares, PositiveSolution_IsTheLinearOne) {
    // [2 1; 1 3] w = [5; 10]  ->  w = (1, 3)
    const auto w = nonnegative_least_squares(std::vector{2.0, 1.0, 1.0, 3.0}, std::vector{5.0, 10.0});
    ASSERT_TRUE(w);
    EXPECT_NEAR((*w)[0], 1.0, 1e-12);
    EXPECT_NEAR((*w)[1], 3.0, 1e-12);
}

TEST(NonnegativeLeastSquares, NegativeCoefficient_IsHeldAtZeroAndTheOtherRefitted) {
    // Unconstrained (-1, 2); with w0 = 0 the other is 5 / 3.
    const auto w = nonnegative_least_squares(std::vector{2.0, 1.0, 1.0, 3.0}, std::vector{0.0, 5.0});
    ASSERT_TRUE(w);
    EXPECT_EQ((*w)[0], 0.0);
    EXPECT_NEAR((*w)[1], 5.0 / 3.0, 1e-12);
}

TEST(NonnegativeLeastSquares, SingularMatrix_IsRefused) {
    const auto w = nonnegative_least_squares(std::vector{1.0, -1.0, -1.0, 1.0}, std::vector{1.0, 1.0});
    ASSERT_FALSE(w);
    EXPECT_EQ(w.error().reason, Reason::no_convergence);
}

TEST(NonnegativeLeastSquares, RandomProblems_MeetTheConditionsOfAMinimum) {
    constexpr std::size_t n = 30;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        NoiseStream draw(seed, "nnls");
        std::vector<double> factor(n * n), g(n * n, 0.0), b(n);
        for (double& value : factor) value = draw.normal();
        for (double& value : b) value = draw.normal();
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j)
                for (std::size_t k = 0; k < n; ++k) g[i * n + j] += factor[i * n + k] * factor[j * n + k];
        const auto w = nonnegative_least_squares(g, b);
        ASSERT_TRUE(w) << w.error().text;
        for (std::size_t i = 0; i < n; ++i) {
            double gradient = -b[i];
            for (std::size_t j = 0; j < n; ++j) gradient += g[i * n + j] * (*w)[j];
            EXPECT_GE((*w)[i], 0.0);
            if ((*w)[i] > 0.0)
                EXPECT_NEAR(gradient, 0.0, 1e-8);
            else
                EXPECT_GT(gradient, -1e-8);
        }
    }
}

}  // namespace
}  // namespace fidservo::calib
