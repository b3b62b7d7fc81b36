// Whether forces balance along recorded ways, and which two effects of a carriage make them.
#include "gap/force_balance.h"

#include "gap/candidate.h"
#include "gap/force_pairs.h"
#include "gap/starts.h"
#include "tests/gap/root_mean_square.h"
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
using testing::rms;

Wanted encoder_of(const Evidence& evidence) {
    return only_of(evidence.windows(), everything(evidence), only(Signal::encoder));
}

class OfAnEffect : public ::testing::TestWithParam<std::string_view> {};

/// What rounding leaves is a standard deviation, two fifths of what excess forces are told in.
TEST_P(OfAnEffect, ForcesBalance_WhereTheHypothesisIsTheTruth) {
    const Hypothesis truth = effects({GetParam()});
    const Evidence evidence = campaign(truth, {"macro-sweep", "macro-pulses"});
    const ForceBalance balance(evidence, encoder_of(evidence));
    ASSERT_GT(balance.supports().size(), 300U);
    const double with_file = rms(evidence, balance.excess_in_own_deviations({}), Signal::encoder),
                 with_truth = rms(evidence, balance.excess_in_own_deviations(truth), Signal::encoder);
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
                      "belt_compliance:stretch_um_per_V=1000,damping_ratio=0.08,motor_share=0.4"));

TEST(ForceBalance, Play_DoesNotShow) {
    for (const plant::Effect* effect : plant::effect_catalogue())
        EXPECT_EQ(shows_in_balance(*effect),
                  effect->block.starts_with("macro.") && effect->name != "backlash")
            << effect->name;
}

std::vector<ForcePair> pairs_of(const Evidence& evidence) {
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    std::vector<const Candidate*> of_carriage;
    for (const Candidate& candidate : all)
        if (shows_in_balance(*candidate.effect)) of_carriage.push_back(&candidate);
    const Wanted wanted = encoder_of(evidence);
    std::vector<ForcePair> pairs = strongest_force_pairs(
        evidence, wanted, {}, of_carriage, seen_along_rail(evidence, {}, wanted, of_carriage).periods);
    for (ForcePair& pair : pairs) pair.first = pair.second = nullptr;  // of candidates that are gone
    return pairs;
}

const plant::EffectSetting* find_setting(const ForcePair& pair, std::string_view effect) {
    const auto found = std::ranges::find_if(
        pair.settings, [&](const plant::EffectSetting& setting) { return setting.effect->name == effect; });
    return found == pair.settings.end() ? nullptr : &*found;
}

const ForcePair* find_with(const std::vector<ForcePair>& pairs, std::string_view effect) {
    const auto found = std::ranges::find_if(
        pairs, [&](const ForcePair& pair) { return find_setting(pair, effect) != nullptr; });
    return found == pairs.end() ? nullptr : &*found;
}

/// Where two effects hide each other: single ones leave a tenth of the gap and more.
TEST(ForcePairs, TwoEffects_ComeBackWithTheirSizes) {
    const std::vector<ForcePair> pairs = pairs_of(
        campaign(effects({"drive_gain:factor=0.92", "coulomb_friction:level_V=0.234,dead_zone_share=0"}),
                 {"macro-sweep", "macro-pulses", "macro-square"}));
    const ForcePair* const found = find_with(pairs, "coulomb_friction");
    ASSERT_NE(found, nullptr);
    EXPECT_NEAR(find_setting(*found, "coulomb_friction")->values[0], 0.234, 0.01);
    const plant::EffectSetting* const gain = find_setting(*found, "drive_gain");
    ASSERT_NE(gain, nullptr);
    EXPECT_NEAR(gain->values[0], 0.92, 0.005);
}

TEST(SlowForcePairs, WaveBesideFrictionThatFallsWithSpeed_ComesBackFirst) {
    const std::vector<ForcePair> pairs =
        pairs_of(campaign(effects({"cogging:amplitude_V=0.35,period_mm=5.08,phase_rad=1",
                                   "stribeck_friction:level_V=0.4,speed_mm_per_s=30"}),
                          {"macro-sweep", "macro-pulses", "macro-square"}));
    ASSERT_FALSE(pairs.empty());
    const plant::EffectSetting *const wave = find_setting(pairs.front(), "cogging"),
                                      *const friction = find_setting(pairs.front(), "stribeck_friction");
    ASSERT_NE(wave, nullptr);
    ASSERT_NE(friction, nullptr);
    EXPECT_NEAR(wave->values[0], 0.35, 0.07);  // smoothed over 17 ms
    EXPECT_NEAR(wave->values[1], 5.08, 0.05);
    EXPECT_NEAR(friction->values[0], 0.4, 0.15);
}

TEST(SlowForcePairs, BeltBesideAWave_ComesBack) {
    const std::vector<ForcePair> pairs = pairs_of(
        campaign(effects({"cogging:amplitude_V=0.3,period_mm=12.7,phase_rad=1",
                          "belt_compliance:stretch_um_per_V=1000,damping_ratio=0.08,motor_share=0.4"}),
                 {"macro-sweep", "macro-pulses", "macro-square"}));
    const ForcePair* const found = find_with(pairs, "belt_compliance");
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found, &pairs.front());
    const plant::EffectSetting *const belt = find_setting(*found, "belt_compliance"), *const wave =
                                                                                          find_setting(
                                                                                              *found,
                                                                                              "cogging");
    ASSERT_NE(wave, nullptr);
    EXPECT_NEAR(wave->values[0], 0.3, 0.06);
    EXPECT_NEAR(wave->values[1], 12.7, 0.2);
    EXPECT_NEAR(belt->values[0], 1000.0, 200.0);
    EXPECT_NEAR(belt->values[2], 0.4, 0.1);
}

TEST(SlowForcePairs, BendOfBristles_WhichTheBalanceDoesNotShow_IsLeftOpen) {
    const std::vector<ForcePair> pairs =
        pairs_of(campaign(effects({"presliding:level_V=0.3,distance_um=200", "rail_patch:level_V=0.5"}),
                          {"macro-sweep", "macro-pulses", "macro-square"}));
    const ForcePair* const found = find_with(pairs, "presliding");
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->starts.size(), 6U) << "three lengths, springs or not";
}

TEST(ForcePairs, OneEffect_NeedsNoSecond) {
    const std::vector<ForcePair> pairs = pairs_of(
        campaign(effects({"drive_gain:factor=0.92"}), {"macro-sweep", "macro-pulses", "macro-square"}));
    EXPECT_TRUE(std::ranges::none_of(pairs, &ForcePair::needs_both));
}

}  // namespace

}  // namespace fidservo
