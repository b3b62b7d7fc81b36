// SPDX-License-Identifier: GPL-3.0-or-later
// Which effects balance a carriage's forces together.
#include "gap/balance/force_regression.h"

#include "gap/evidence/halves.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::campaign;
using testing::effects;

constexpr double tail = 0.01;

std::vector<BalancedModel> models_of(const Hypothesis& truth, const Hypothesis& known = {}) {
    const Evidence evidence = campaign(truth, {"macro-sweep", "macro-pulses", "macro-square"});
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    std::vector<const Candidate*> tried(all.size());
    std::ranges::transform(all, tried.begin(), [](const Candidate& candidate) { return &candidate; });
    std::vector<BalancedModel> models = balanced_models(evidence, halves(evidence), known, tried, tail);
    for (BalancedModel& model : models) model.candidates.clear();  // they end with this function
    return models;
}

const plant::EffectSetting* find(const BalancedModel& model, std::string_view effect) {
    const auto found =
        std::ranges::find(model.settings, effect, [](const auto& setting) { return setting.effect->name; });
    return found == model.settings.end() ? nullptr : &*found;
}

TEST(ForceRegression, RigAsItsFileSays_NeedsNoEffect) {
    EXPECT_TRUE(models_of({}).empty());
}

TEST(ForceRegression, OneEffect_IsTakenInFirstWithItsSize) {
    const auto models = models_of(effects({"payload:mass_factor=1.3"}));
    ASSERT_FALSE(models.empty());
    const plant::EffectSetting* const payload = find(models.front(), "payload");
    ASSERT_NE(payload, nullptr);
    EXPECT_NEAR(payload->values[0], 1.3, 0.02);
}

TEST(ForceRegression, WhatIsKnown_IsNotTakenInAgain) {
    const Hypothesis truth = effects({"payload:mass_factor=1.3"});
    EXPECT_TRUE(models_of(truth, truth).empty());
}

TEST(ForceRegression, ThreeEffects_AreFoundTogether) {
    const auto models =
        models_of(effects({"payload:mass_factor=1.2", "cogging:amplitude_V=0.1,period_mm=6.3,phase_rad=1",
                           "coulomb_friction:level_V=0.2"}));
    ASSERT_GE(models.size(), 3U);
    const BalancedModel& three = models[2];
    for (const char* name : {"payload", "cogging", "coulomb_friction"})
        ASSERT_NE(find(three, name), nullptr) << name;
    EXPECT_NEAR(find(three, "payload")->values[0], 1.2, 0.03);
    EXPECT_NEAR(find(three, "cogging")->values[0], 0.1, 0.02);
    EXPECT_NEAR(find(three, "cogging")->values[1], 6.3, 0.05);
    EXPECT_NEAR(find(three, "coulomb_friction")->values[0], 0.2, 0.02);
}

TEST(ForceRegression, BeltDelayAndScale_AreNoForcesOfOneRow) {
    const Evidence evidence = campaign({}, {"macro-pulses"});
    std::set<std::string_view> others;
    for (const Candidate& candidate : candidates(evidence, {}, {}))
        if (shows_in_balance(*candidate.effect) && !is_force(evidence.rig(), candidate))
            others.insert(candidate.effect->name);
    EXPECT_EQ(others, (std::set<std::string_view>{"drive_delay", "belt_compliance", "encoder_scale"}));
}

}  // namespace

}  // namespace fidservo
