// SPDX-License-Identifier: GPL-3.0-or-later
// Waves of a force along the rail, from the balance of the forces along the way recorded.
#include "gap/balance/balanced_waves.h"

#include "gap/starts/starts.h"
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

/// The fitted waves, given the known effects.
std::vector<plant::EffectSetting> waves_of(const Hypothesis& truth, std::string_view wave,
                                           const Hypothesis& known) {
    const Evidence evidence = campaign(truth, {"macro-sweep", "macro-pulses", "macro-square"});
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    const auto candidate = std::ranges::find(all, wave, [](const Candidate& c) { return c.effect->name; });
    const Wanted wanted = everything(evidence);
    return balanced_waves(evidence, wanted, known, *candidate,
                          periods_along_rail(evidence, known, evidence.errors(known, wanted)));
}

/// At 10 mV a carriage that is predicted to stop moves on in half of the windows.
TEST(BalancedWaves, WeakWave_ComesBackFirst) {
    const auto waves =
        waves_of(effects({"cogging:amplitude_V=0.012,period_mm=6.1,phase_rad=1"}), "cogging", {});
    ASSERT_FALSE(waves.empty());
    EXPECT_NEAR(waves.front().values[0], 0.012, 0.003);
    EXPECT_NEAR(waves.front().values[1], 6.1, 0.06);
}

TEST(SlowBalancedWaves, HarmonicThatShows_ComesWithIt) {
    const auto waves = waves_of(
        effects({"cogging:amplitude_V=0.4,period_mm=7.05,phase_rad=-2,second_sine=0.2,second_cosine=-0.2"}),
        "cogging", {});
    ASSERT_FALSE(waves.empty());
    EXPECT_NEAR(waves.front().values[1], 7.05, 0.02);
    EXPECT_NEAR(waves.front().values[3], 0.2, 0.1);
    EXPECT_NEAR(waves.front().values[4], -0.2, 0.1);
}

TEST(BalancedWaves, BesideWhatIsKnown_TakesNoneOfIt) {
    const Hypothesis both = effects({"payload:mass_factor=1.4", "cogging:amplitude_V=0.1,period_mm=9.3"});
    const auto waves = waves_of(both, "cogging", {both.front()});
    ASSERT_FALSE(waves.empty());
    EXPECT_NEAR(waves.front().values[0], 0.1, 0.02);
    EXPECT_NEAR(waves.front().values[1], 9.3, 0.05);
}

TEST(BalancedWaves, WaveOfTheReading_IsNoForce) {
    EXPECT_TRUE(
        waves_of(effects({"encoder_ripple:amplitude_um=60,period_mm=8"}), "encoder_ripple", {}).empty());
}

}  // namespace

}  // namespace fidservo
