// SPDX-License-Identifier: GPL-3.0-or-later
// How well explanations are told apart, against closed forms.
#include "src/design/discrimination.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::design {
namespace {

/// One window of errors e and slopes J.
std::vector<WindowProducts> window_of(const Eigen::VectorXd& errors, const Eigen::MatrixXd& slopes) {
    gap::Window window{};
    window.end = static_cast<std::size_t>(errors.size());
    const gap::Errors values(errors.data(), errors.data() + errors.size());
    std::vector<gap::Errors> columns;
    for (Eigen::Index k = 0; k < slopes.cols(); ++k)
        columns.emplace_back(slopes.col(k).data(), slopes.col(k).data() + slopes.rows());
    return products_of(std::vector{window}, values, columns);
}

TEST(Discrimination, LinearExplanations_DifferByWhatNoSlopeTakesUp) {
    // A slope of 1e3 errors a standard deviation leaves the rival free; what is left is |P e|^2 / (2 n).
    const Eigen::Vector3d slope(1e3, 2e3, -2e3), across(2.0, 0.0, 1.0);
    constexpr double small = 1e-2;
    const Eigen::VectorXd errors = small * across + 3e-4 * slope;
    const Adjusted found = adjusted(window_of(errors, slope), Eigen::VectorXd::Zero(1));
    const double expected = (small * across).squaredNorm() / (2.0 * 3.0);
    EXPECT_NEAR(found.loss, expected, 2e-3 * expected);
    EXPECT_NEAR(found.z(0), -3e-4, 1e-6);
}

TEST(Discrimination, KnownValue_CostsWhatItsUncertaintySays) {
    // One small error e with slope s: the least of (e + s z)^2 / 2 + z^2 / 2 is e^2 / (2 (1 + s^2)).
    constexpr double error = 1e-3, slope = 2.0;
    const Adjusted found =
        adjusted(window_of(Eigen::VectorXd::Constant(1, error), Eigen::MatrixXd::Constant(1, 1, slope)),
                 Eigen::VectorXd::Zero(1));
    const double expected = error * error / (2.0 * (1.0 + slope * slope));
    EXPECT_NEAR(found.loss, expected, 1e-4 * expected);
}

TEST(Discrimination, LargeError_CountsByItsLogarithm) {
    const Adjusted found =
        adjusted(window_of(Eigen::VectorXd::Constant(4, 100.0), Eigen::MatrixXd(4, 0)), Eigen::VectorXd(0));
    EXPECT_NEAR(found.loss, 0.5 * std::log1p(1e4), 1e-9);
}

TEST(Discrimination, ValuesThatAreMissing_CountNothing) {
    Eigen::VectorXd errors(3);
    errors << 1.0, std::nan(""), 1.0;
    const auto windows = window_of(errors, Eigen::MatrixXd(3, 0));
    ASSERT_EQ(windows.size(), 1U);
    EXPECT_EQ(windows.front().count, 2.0);
    EXPECT_TRUE(window_of(Eigen::VectorXd::Constant(2, std::nan("")), Eigen::MatrixXd(2, 0)).empty());
}

TEST(Discrimination, SpreadAtABound_GoesInwardsOnly) {
    Explanation explanation;
    explanation.hypothesis = {};
    explanation.spread = Eigen::MatrixXd(0, 1);
    explanation.is_one_sided = {true};
    EXPECT_TRUE(moved(explanation, Eigen::VectorXd::Constant(1, -2.0)).empty());
}

}  // namespace
}  // namespace fidservo::design
