// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compare/comparison.h"

#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "src/files/rig/rig_file.h"
#include "src/simulation/experiments.h"
#include "src/simulation/simulate.h"
#include "tests/effort.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fidservo::compare {
namespace {

std::vector<Recording> campaign_of(const Rig& rig, const std::vector<std::string>& effects,
                                   std::uint64_t seed) {
    std::vector<plant::EffectSetting> settings;
    settings.reserve(effects.size());
    for (const std::string& effect : effects) settings.push_back(plant::parse_effect(effect));
    std::vector<Recording> recordings;
    for (const CampaignRun& run : campaign_runs(rig))
        recordings.push_back(
            simulate(rig, settings, make_experiment(run.kind, rig, seed, run.name), run.name, seed));
    return recordings;
}

Comparison compared(const std::vector<std::string>& before, const std::vector<std::string>& after,
                    std::uint64_t seed) {
    const Rig rig = load_rig(reference_rig_file());
    return compare(
        rig, {campaign_of(rig, before, seed), {}}, {campaign_of(rig, after, seed + 1), {}},
        [] { return false; }, [](std::string_view) {});
}

const ParameterPair* find_pair(const Comparison& comparison, std::string_view effect) {
    const auto found = std::ranges::find(comparison.shared, effect, &ParameterPair::effect);
    return found == comparison.shared.end() ? nullptr : &*found;
}

gap::SignalGap encoder(double before, double after) {
    return {.signal = gap::Signal::encoder, .before = before, .after = after, .floor = 0.3};
}

/// A second diagnosis may name what the first one passed over, without any change.
TEST(Comparison, WhatIsNamedInB_IsNewOnlyWhereBIsPredictedWorseThanA) {
    Comparison comparison;
    comparison.beyond.effects.emplace_back().effect = "belt_compliance";
    comparison.before.signals = {encoder(40.0, 2.0)};
    comparison.beyond.signals = {encoder(2.1, 0.3)};
    EXPECT_FALSE(comparison.has_changed());
    comparison.beyond.signals = {encoder(2.3, 0.3)};
    EXPECT_TRUE(comparison.has_changed());
    comparison.before.signals = {encoder(40.0, 0.2)};
    comparison.beyond.signals = {encoder(0.32, 0.3)};
    EXPECT_FALSE(comparison.has_changed()) << "noise";
    comparison.beyond.effects.clear();
    comparison.beyond.signals = {encoder(5.0, 5.0)};
    EXPECT_FALSE(comparison.has_changed()) << "nothing is named, and nothing left";
    comparison.beyond.unexplained.emplace();
    EXPECT_TRUE(comparison.has_changed());
}

/// One pair as a guard; all of them together for the share of false alarms.
TEST(SlowComparison, SameRig_HasNotChanged) {
    constexpr std::array<std::uint64_t, 3> seeds{610, 620, 630};
    constexpr std::array effects{"drive_gain:factor=1.08", "hall_gain:factor=1.02", "backlash:width_um=150"};
    const auto pairs = static_cast<std::size_t>(testing::draws(9, 1));
    for (std::size_t pair = 0; pair < pairs; ++pair) {
        const std::string effect = effects[pair % effects.size()];
        const std::uint64_t seed = seeds[(pair + pair / effects.size()) % seeds.size()];
        EXPECT_FALSE(compared({effect}, {effect}, seed).has_changed()) << effect << ", seed " << seed;
    }
}

TEST(SlowComparison, EffectOfAnotherSize_HasChanged) {
    if (!testing::has_all_draws()) GTEST_SKIP() << "of all draws: beside another change it is looked at, too";
    const Comparison comparison = compared({"backlash:width_um=150"}, {"backlash:width_um=350"}, 640);
    const ParameterPair* width = find_pair(comparison, "backlash");
    ASSERT_NE(width, nullptr);
    EXPECT_TRUE(width->has_changed);
    EXPECT_NEAR(width->after - width->before, 200.0, 25.0);
    EXPECT_TRUE(comparison.beyond.effects.empty());
}

TEST(SlowComparison, OneChangesAndOneComes_BothAreSaid) {
    const Comparison comparison =
        compared({"backlash:width_um=150"}, {"backlash:width_um=350", "hall_gain:factor=1.03"}, 650);
    const ParameterPair* width = find_pair(comparison, "backlash");
    ASSERT_NE(width, nullptr);
    EXPECT_TRUE(width->has_changed);
    ASSERT_EQ(comparison.beyond.effects.size(), 1U);
    EXPECT_EQ(comparison.beyond.effects[0].effect, "hall_gain");
    const auto json = nlohmann::json::parse(comparison_json(comparison));
    EXPECT_EQ(json["format"], "fidservo-comparison/1");
    EXPECT_EQ(json["changed"], true);
}

TEST(SlowComparison, EffectThatWent_IsSaid) {
    const Comparison comparison = compared({"hall_gain:factor=1.03"}, {}, 660);
    const ParameterPair* factor = find_pair(comparison, "hall_gain");
    ASSERT_NE(factor, nullptr);
    EXPECT_TRUE(factor->has_changed);
    EXPECT_NEAR(factor->after, 1.0, 0.002);
}

}  // namespace
}  // namespace fidservo::compare
