// SPDX-License-Identifier: GPL-3.0-or-later
// Errors to first order, against solutions in closed form and against errors that are added up row by row.
#include "gap/starts/linear_errors.h"

#include "core/random.h"
#include "gap/fit/score.h"
#include "tests/gap/equal_windows.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

constexpr std::size_t rows = 50;

Errors drawn_errors(NoiseStream& noise) {
    Errors errors(4 * rows);
    for (float& error : errors) error = static_cast<float>(noise.normal());
    return errors;
}

/// e + sum x_k c_k.
Errors added_up(const Errors& errors, const std::vector<Errors>& changes, const Eigen::VectorXd& shares) {
    Errors sum = errors;
    for (std::size_t k = 0; k < changes.size(); ++k)
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += static_cast<float>(shares(static_cast<Eigen::Index>(k))) * changes[k][i];
    return sum;
}

/// Two windows with one row each, off by 3 and 1, and one change, 1 in both: the shares x that minimise
/// (3 + x)^2 / 10 + (1 + x)^2 / 2 are x = -(3 / 10 + 1 / 2) / (1 / 10 + 1 / 2) = -4 / 3.
TEST(LinearErrors, OfOneChange_AreLeastWhereTheClosedFormSays) {
    const std::vector<Window> windows = testing::equal_windows(2, 1);
    const LinearErrors linear(windows, {3.0F, 1.0F}, {{1.0F, 1.0F}});
    const LinearErrors::Optimum optimum = linear.optimum({1, 1});
    EXPECT_NEAR(optimum.shares(0), -4.0 / 3.0, 1e-12);
    EXPECT_NEAR(optimum.mean_squares[0], 25.0 / 9.0, 1e-6);
    EXPECT_NEAR(optimum.mean_squares[1], 1.0 / 9.0, 1e-6);
}

TEST(LinearErrors, OfTwoKnownAndTwoFurtherChanges_AreThoseOfFourKnownOnes) {
    const std::vector<Window> windows = testing::equal_windows(4, rows);
    NoiseStream noise(1, "errors");
    const Errors errors = drawn_errors(noise);
    std::vector<Errors> changes;
    changes.reserve(4);
    for (int k = 0; k < 4; ++k) changes.push_back(drawn_errors(noise));
    const Wanted counted{1, 0, 1, 1};
    const LinearErrors::Optimum at_once = LinearErrors(windows, errors, changes).optimum(counted);
    const LinearErrors::Optimum in_turn =
        LinearErrors(windows, errors, {changes[0], changes[1]}).optimum(counted, {changes[2], changes[3]});
    EXPECT_NEAR((at_once.shares - in_turn.shares).norm(), 0.0, 1e-12);
    const std::vector<double> squares = mean_squares(windows, added_up(errors, changes, at_once.shares));
    EXPECT_TRUE(std::isnan(in_turn.mean_squares[1]));
    for (const std::size_t w : {0, 2, 3}) EXPECT_NEAR(in_turn.mean_squares[w], squares[w], 1e-6) << w;
}

TEST(LinearErrors, RowsThatDoNotCount_ChangeNothing) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float infinite = std::numeric_limits<float>::infinity();
    const std::vector<Window> windows{{.begin = 0, .end = 3}, {.begin = 3, .end = 4}};
    const LinearErrors::Optimum optimum =
        LinearErrors(windows, {3.0F, nan, 1.0F, nan}, {{1.0F, 5.0F, infinite, 5.0F}}).optimum({1, 1});
    EXPECT_NEAR(optimum.shares(0), -3.0, 1e-12);
    EXPECT_NEAR(optimum.mean_squares[0], 0.5, 1e-6);
    EXPECT_TRUE(std::isnan(optimum.mean_squares[1]));
}

/// An offset of all rows that a parameter which may be refitted takes back leaves nothing for a further
/// change: the smallest shares are taken.
TEST(LinearErrors, SameChangeTwice_IsSharedEqually) {
    const std::vector<Window> windows = testing::equal_windows(1, 2);
    const LinearErrors linear(windows, {2.0F, 2.0F}, {{1.0F, 1.0F}});
    const LinearErrors::Optimum optimum = linear.optimum({1}, {{1.0F, 1.0F}});
    EXPECT_NEAR(optimum.shares(0), -1.0, 1e-9);
    EXPECT_NEAR(optimum.shares(1), -1.0, 1e-9);
}

}  // namespace
}  // namespace fidservo
