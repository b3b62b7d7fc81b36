// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/verdict/correlated.h"

#include "tests/gap/effects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Two parameters of one effect, one of another.
Fit fitted_with(double between_effects, double within_one) {
    Fit fit{.hypothesis =
                testing::effects({"friction_asymmetry:right_V_s_per_mm=0.001", "drive_gain:factor=1.02"}),
            .loss = 0.0,
            .covariance = Eigen::MatrixXd(3, 3)};
    constexpr double second = 1e-3;  // standard deviation of the second parameter; the others have 1
    fit.covariance << 1.0, second * within_one, between_effects,         //
        second * within_one, second * second, second * between_effects,  //
        between_effects, second * between_effects, 1.0;
    return fit;
}

TEST(CorrelatedParameters, OfTwoEffects_AreSaid_WhateverTheirUnits) {
    const auto lines = correlated_parameters(fitted_with(-0.97, 0.0));
    EXPECT_THAT(lines, ElementsAre(HasSubstr("friction_asymmetry right_V_s_per_mm and drive_gain factor"),
                                   HasSubstr("friction_asymmetry left_V_s_per_mm and drive_gain factor")));
    EXPECT_THAT(lines.front(), HasSubstr("correlation -0.970"));
    EXPECT_THAT(lines.front(), HasSubstr("less of the other"));
}

TEST(CorrelatedParameters, OfOneEffect_OrWeakly_AreNot) {
    EXPECT_THAT(correlated_parameters(fitted_with(0.9, 0.99)), IsEmpty());
    EXPECT_THAT(correlated_parameters({.hypothesis = testing::effects({"drive_gain"}),
                                       .loss = 0.0,
                                       .covariance = Eigen::MatrixXd::Zero(1, 1)}),
                IsEmpty());
}

}  // namespace

}  // namespace fidservo
