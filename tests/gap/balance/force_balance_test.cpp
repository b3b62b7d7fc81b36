// SPDX-License-Identifier: GPL-3.0-or-later
// Whether forces balance along recorded paths.
#include "gap/balance/force_balance.h"

#include "gap/candidates/coupling.h"
#include "tests/gap/root_mean_square.h"
#include "tests/gap/simulated_campaign.h"

#include <string_view>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::campaign;
using testing::effects;
using testing::rms;

Wanted encoder_of(const Evidence& evidence) {
    return only_of(evidence.windows(), everything(evidence), only(Signal::encoder));
}

class OfAnEffect : public ::testing::TestWithParam<std::string_view> {};

/// With the true forces one standard deviation of rounding remains: 0.4 in the units of 2.5 standard
/// deviations in which excess forces are given.
TEST_P(OfAnEffect, ForcesBalance_WhereTheHypothesisIsTheTruth) {
    const Hypothesis truth = effects({GetParam()});
    const Evidence evidence = campaign(truth, {"macro-sweep", "macro-pulses"});
    const auto excess_under = [&](const Hypothesis& hypothesis) {
        const ForceBalance balance(evidence, encoder_of(evidence), hypothesis);
        const Errors excess = balance.excess_in_own_deviations(hypothesis);
        EXPECT_GT(excess.size(), 300U);
        return rms(balance.windows(), excess, Signal::encoder);
    };
    const double with_file = excess_under({}), with_truth = excess_under(truth);
    EXPECT_NEAR(with_truth, 0.4, 0.1);
    EXPECT_GT(with_file, 3.0 * with_truth);
}

INSTANTIATE_TEST_SUITE_P(
    Each, OfAnEffect,
    ::testing::Values("drive_gain:factor=0.9", "drive_offset:offset_V=0.2", "drive_delay:delay_ms=8",
                      "coulomb_friction:level_V=0.3", "stribeck_friction:level_V=0.5,speed_mm_per_s=60",
                      "payload:mass_factor=1.5", "viscous_friction:damping_V_s_per_mm=0.002",
                      "rail_patch:level_V=0.5", "cogging:amplitude_V=0.3,period_mm=12.7",
                      "cable_force:stiffness_V_per_mm=0.005", "encoder_scale:factor=1.1",
                      "encoder_ripple:amplitude_um=200,period_mm=9.3,phase_rad=0.7",
                      "belt_compliance:stretch_um_per_V=1000,damping_ratio=0.08,motor_share=0.4"));

TEST(ForceBalance, Play_DoesNotShow) {
    for (const plant::Effect* effect : plant::effect_catalogue())
        EXPECT_EQ(shows_in_balance(*effect),
                  effect->block.starts_with("macro.") && effect->name != "backlash")
            << effect->name;
}

}  // namespace

}  // namespace fidservo
