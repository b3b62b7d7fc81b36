// SPDX-License-Identifier: GPL-3.0-or-later
// Sizes of effects by the balance of forces alone, against those with which recordings were simulated.
#include "gap/balance/balance_fit.h"

#include "tests/gap/simulated_campaign.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;
using testing::campaign;
using testing::effects;

TEST(BalanceFit, SizesOfForces_ComeBackFromSomeOfTheirHalf) {
    const Hypothesis truth =
        effects({"viscous_friction:damping_V_s_per_mm=0.001", "drive_offset:offset_V=0.02"});
    const Evidence evidence = campaign(truth, {"macro-sweep", "macro-pulses"});
    const Wanted wanted = everything(evidence);
    const Hypothesis base;
    const ForceBalance balance(evidence, wanted, base);
    const BalanceFit fit(balance, wanted, base);
    const Fit found =
        fit.fit(effects({"viscous_friction:damping_V_s_per_mm=0.0005", "drive_offset:offset_V=0.01"}));
    ASSERT_EQ(found.hypothesis.size(), 2U);
    EXPECT_NEAR(found.hypothesis[0].values.front(), 0.001, 1e-4);
    EXPECT_NEAR(found.hypothesis[1].values.front(), 0.02, 2e-3);
}

TEST(BalanceFit, ErrorsUnderTheTruth_AreAsLargeAsTheReadingsNoiseMakesThem) {
    const Hypothesis truth = effects({"viscous_friction:damping_V_s_per_mm=0.001"});
    const Evidence evidence = campaign(truth, {"macro-sweep", "macro-pulses"});
    const Wanted wanted = everything(evidence);
    const Hypothesis base;
    const ForceBalance balance(evidence, wanted, base);
    const BalanceFit fit(balance, wanted, base);
    const auto mean_square = [&](const Hypothesis& settings) {
        double squares = 0.0, count = 0.0;
        for (const double error : fit.errors(settings)) {
            if (std::isnan(error)) continue;
            squares += error * error;
            count += 1.0;
        }
        return squares / count;
    };
    const double expected = std::pow(ForceBalance::deviations, -2);
    EXPECT_NEAR(mean_square(truth), expected, 0.4 * expected);
    EXPECT_GT(mean_square(effects({"viscous_friction:damping_V_s_per_mm=0.002"})), 2.0 * mean_square(truth));
}

}  // namespace
}  // namespace fidservo
