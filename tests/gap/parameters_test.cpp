// SPDX-License-Identifier: GPL-3.0-or-later
// Which of an effect's parameters a diagnosis states, and how uncertain they are.
#include "gap/parameters.h"

#include "plant/effects/catalogue.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

TEST(Parameters, AreAsUncertainAsTheCurvatureSaysAndTheHalvesDiffer) {
    const plant::EffectSetting whole = plant::parse_effect("payload:mass_factor=1.10"),
                               one = plant::parse_effect("payload:mass_factor=1.12"),
                               other = plant::parse_effect("payload:mass_factor=1.06");
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(4, 4);
    covariance(2, 2) = std::pow(0.04, 2);
    const std::vector<FittedParameter> stated = parameters_of(whole, {one, other}, covariance, 2);
    ASSERT_EQ(stated.size(), 1U);
    EXPECT_EQ(stated.front().name, "mass_factor");
    EXPECT_DOUBLE_EQ(stated.front().value, 1.10);
    EXPECT_NEAR(stated.front().std, std::hypot(0.04, 0.03), 1e-12);
}

TEST(Parameters, OptionalOnesThatAreAbsent_AndUsualChoices_AreNotStated) {
    const plant::EffectSetting friction = plant::parse_effect("coulomb_friction:level_V=0.2");
    const auto size = static_cast<Eigen::Index>(friction.values.size());
    const std::vector<FittedParameter> stated =
        parameters_of(friction, {friction, friction}, Eigen::MatrixXd::Zero(size, size), 0);
    for (const FittedParameter& parameter : stated) EXPECT_NE(parameter.name, "only_coasting");
    ASSERT_FALSE(stated.empty());
    EXPECT_EQ(stated.front().name, "level_V");
    EXPECT_EQ(stated.front().unit, "V");

    const plant::EffectSetting coasting =
        plant::parse_effect("coulomb_friction:dead_zone_share=0.5,only_coasting=1");
    bool is_choice_stated = false;
    for (const FittedParameter& parameter :
         parameters_of(coasting, {coasting, coasting}, Eigen::MatrixXd::Zero(size, size), 0))
        is_choice_stated = is_choice_stated || parameter.name == "only_coasting";
    EXPECT_TRUE(is_choice_stated);
}

}  // namespace
}  // namespace fidservo
