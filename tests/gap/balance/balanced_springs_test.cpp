// SPDX-License-Identifier: GPL-3.0-or-later
// Springs along the rail, from the balance of the forces along the way recorded.
#include "gap/balance/balanced_springs.h"

#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::campaign;
using testing::effects;

Candidate candidate_of(const Evidence& evidence, std::string_view name) {
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    return *std::ranges::find(all, name, [](const Candidate& c) { return c.effect->name; });
}

std::vector<plant::EffectSetting> springs_of(const Hypothesis& truth, const Hypothesis& known,
                                             std::string_view name = "cable_force") {
    const Evidence evidence = campaign(truth, {"macro-sweep", "macro-pulses", "macro-square"});
    return balanced_springs(evidence, everything(evidence), known, candidate_of(evidence, name));
}

TEST(BalancedSprings, HardeningOne_ComesBackBesideThePlainOne) {
    const auto springs =
        springs_of(effects({"cable_force:stiffness_V_per_mm=0.001,centre_mm=85,hardening=3"}), {});
    ASSERT_EQ(springs.size(), 2U);
    EXPECT_EQ(springs[0].values[2], 0.0);
    EXPECT_NEAR(springs[1].values[0], 0.001, 2e-4);
    EXPECT_NEAR(springs[1].values[1], 85.0, 3.0);
    EXPECT_NEAR(springs[1].values[2], 3.0, 0.8);
}

TEST(BalancedSprings, OneThatDoesNotHarden_ComesBack) {
    const auto springs = springs_of(effects({"cable_force:stiffness_V_per_mm=0.002,centre_mm=120"}), {});
    ASSERT_EQ(springs.size(), 2U);
    for (const plant::EffectSetting& spring : springs) {
        EXPECT_NEAR(spring.values[0], 0.002, 2e-4);
        EXPECT_NEAR(spring.values[1], 120.0, 3.0);
        EXPECT_LT(spring.values[2], 0.2);
    }
}

TEST(BalancedSprings, BesideWhatIsKnown_TakesNoneOfIt) {
    const Hypothesis both =
        effects({"payload:mass_factor=1.4", "cable_force:stiffness_V_per_mm=0.002,centre_mm=90"});
    const auto springs = springs_of(both, {both.front()});
    ASSERT_FALSE(springs.empty());
    EXPECT_NEAR(springs.front().values[0], 0.002, 3e-4);
    EXPECT_NEAR(springs.front().values[1], 90.0, 4.0);
}

TEST(BalancedSprings, OfAnotherEffect_AreNone) {
    EXPECT_TRUE(springs_of({}, {}, "drive_offset").empty());
    EXPECT_TRUE(springs_of({}, {}, "belt_compliance").empty());
}

}  // namespace

}  // namespace fidservo
