// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/worth.h"

#include "tests/gap/effects.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::effects;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Candidates with settings and a loss of given second derivatives.
struct Fitted {
    std::vector<Candidate> all = gap::candidates(testing::campaign({}, {"micro-steps"}), {}, {});
    std::vector<const Candidate*> candidates;
    Fit fit;

    explicit Fitted(Hypothesis settings, const Eigen::MatrixXd& second_derivatives) {
        for (const plant::EffectSetting& setting : settings)
            candidates.push_back(&*std::ranges::find(all, setting.effect, &Candidate::effect));
        fit.hypothesis = std::move(settings);
        fit.curvature_covariance = second_derivatives.inverse();
    }
};

TEST(Worth, OfOneSize_IsHalfItsSquareOverItsVariance) {
    const Fitted one(effects({"stroke_change:factor=1.02"}), Eigen::MatrixXd::Constant(1, 1, 1.0 / 1e-6));
    EXPECT_NEAR(worth_of_each(one.candidates, one.fit).front(), 0.5 * 4e-4 / 1e-6, 1e-6);
    EXPECT_THAT(kept(one.candidates, one.fit, {}, false), ElementsAre(0));
}

/// Two sizes of which the data determine the sum alone: each by itself may go, but not both.
TEST(Worth, OfSizesThatStandInForEachOther_IsSmallForEach_AndOneStays) {
    Eigen::MatrixXd of_sum(2, 2);
    of_sum << 1.0, 1.0, 1.0, 1.0;
    const Fitted two(effects({"stroke_change:factor=1.02", "heating_lag:factor=1.02"}),
                     1e6 * of_sum + 1e2 * Eigen::MatrixXd::Identity(2, 2));
    for (const double worth : worth_of_each(two.candidates, two.fit)) EXPECT_LT(worth, least_worth);
    EXPECT_EQ(kept(two.candidates, two.fit, {}, false).size(), 1U);
}

/// What the third does alone, the first two do nearly as well together, and fitted with all three the data
/// are shared out so that the third saves least. It stays alone nevertheless.
TEST(Worth, OfTwoThatTogetherStandInForAThird_IsNothingBesideIt_AndItTakesTheirPlace) {
    constexpr double apart = 0.1, scale = 1e-2;
    const double along = std::sqrt(0.5 * (1.0 - apart * apart));
    Eigen::Matrix3d responses;  // one column for each
    responses << 1.0, 0.0, along, 0.0, 1.0, along, 0.0, 0.0, apart;
    responses /= scale;
    const Fitted three(
        effects({"stroke_change:factor=1.07", "heating_lag:factor=1.07", "heater_gain:factor=1.02"}),
        responses.transpose() * responses);
    const std::vector<double> worth = worth_of_each(three.candidates, three.fit);
    EXPECT_LT(worth[2], worth[0]);
    EXPECT_THAT(kept(three.candidates, three.fit, {}, false), ElementsAre(2));
}

/// The data determine size times shape alone. A shape that was free to move would make up for any smaller
/// size; at size zero none does.
TEST(Worth, OfAnEffectWhoseShapeIsNotDetermined_IsWhatItsSizeSavesWithThatShape) {
    const Hypothesis mass = effects({"second_thermal_mass:conductance=0.2,mass_tau_s=50"});
    const double size = mass.front().values[0], shape = mass.front().values[1], deviation = 0.1;
    const auto count = static_cast<Eigen::Index>(mass.front().values.size());
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(count);
    gradient.head(2) << shape, size;
    const Fitted one(mass, gradient * gradient.transpose() / (deviation * deviation) +
                               1e-9 * Eigen::MatrixXd::Identity(count, count));
    const double expected = 0.5 * std::pow(size * shape / deviation, 2);
    EXPECT_NEAR(worth_of_each(one.candidates, one.fit).front(), expected, 1e-3 * expected);
    EXPECT_THAT(kept(one.candidates, one.fit, {}, false), ElementsAre(0));
}

/// The size of the one does what a longer time constant of the other does: without it nothing is lost.
TEST(Worth, OfWhatTheShapeOfAnotherEffectDoesAsWell_IsSmall) {
    const Hypothesis both = effects({"stroke_change:factor=1.02", "second_thermal_mass:conductance=0.2"});
    const auto count = 1 + static_cast<Eigen::Index>(both[1].values.size());
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(count);
    gradient(0) = gradient(2) = 1e3;  // the time constant is the second parameter of the thermal mass
    Eigen::MatrixXd second_derivatives =
        gradient * gradient.transpose() + 1e-3 * Eigen::MatrixXd::Identity(count, count);
    second_derivatives(1, 1) = 1e6;
    const Fitted fitted(both, second_derivatives);
    const std::vector<double> worth = worth_of_each(fitted.candidates, fitted.fit);
    EXPECT_LT(worth[0], least_worth);
    EXPECT_NEAR(worth[1], 0.5 * 1e6 * 0.2 * 0.2, 1.0);
    EXPECT_THAT(kept(fitted.candidates, fitted.fit, {}, false), ElementsAre(1));
}

TEST(Worth, OfWhatABoundHolds_IsNothing_AndMayBeSpared) {
    Fitted held(effects({"heater_delay:delay_ms=0"}), Eigen::MatrixXd::Identity(1, 1));
    held.fit.curvature_covariance.setZero();
    EXPECT_EQ(worth_of_each(held.candidates, held.fit).front(), 0.0);
    EXPECT_THAT(kept(held.candidates, held.fit, {}, false), IsEmpty());
    EXPECT_THAT(kept(held.candidates, held.fit, {}, true), ElementsAre(0));
}

}  // namespace

}  // namespace fidservo
