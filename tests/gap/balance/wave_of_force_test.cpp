// SPDX-License-Identifier: GPL-3.0-or-later
// A periodic force on simulated carriages.
#include "gap/balance/wave_of_force.h"

#include "tests/gap/simulated_campaign.h"

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;
using testing::campaign;
using testing::effects;

WaveOfForce wave_along_the_rail(const Hypothesis& truth) {
    const Evidence evidence = campaign(truth, {"macro-sweep"});
    const CarriageForces forces(evidence, evidence.errors({}, everything(evidence)), short_half_support);
    return strongest_wave(
        forces, [](const SlidingRow& row) { return row.position_mm; }, [](const SlidingRow&) { return 1.0; },
        2.0, 50.0);
}

TEST(WaveOfForce, RippleOfTheRail_IsFoundWithItsPeriod) {
    const WaveOfForce wave =
        wave_along_the_rail(effects({"cogging:amplitude_V=0.1,period_mm=9,phase_rad=0.7"}));
    EXPECT_NEAR(wave.period, 9.0, 0.3);
    EXPECT_GT(wave.share, 0.3);
}

TEST(WaveOfForce, NoiseHasNoStrongWave) {
    EXPECT_LT(wave_along_the_rail({}).share, 0.1);
}

TEST(WaveOfForce, QuantityThatHardlyVaries_HasNone) {
    const Evidence evidence = campaign({}, {"macro-sweep"});
    const CarriageForces forces(evidence, evidence.errors({}, everything(evidence)), short_half_support);
    const WaveOfForce wave = strongest_wave(
        forces, [](const SlidingRow&) { return 3.0; }, [](const SlidingRow&) { return 1.0; }, 2.0, 50.0);
    EXPECT_DOUBLE_EQ(wave.share, 0.0);
}

}  // namespace
}  // namespace fidservo
