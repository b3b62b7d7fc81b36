// SPDX-License-Identifier: GPL-3.0-or-later
// Cases are the same for the same seed and evenly distributed over classes, and nothing that the diagnosis
// gets reveals their causes.
#include "src/selfcheck/draw/case_draw.h"

#include "core/rig.h"
#include "gap/candidates/candidate.h"
#include "plant/effects/catalogue.h"
#include "src/files/rig/rig_file.h"
#include "src/selfcheck/draw/campaign.h"
#include "src/selfcheck/draw/listed_effects.h"
#include "src/selfcheck/draw/unlisted_effects.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace fidservo::selfcheck {
namespace {

const Rig& nominal() {
    static const Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    return rig;
}

/// The first cases of a kind.
std::vector<Case> cases_of(CaseKind kind, std::uint64_t seed, std::size_t count) {
    std::vector<Case> cases;
    for (std::size_t number = 0; cases.size() < count; ++number)
        if (kind_of_case(seed, number) == kind) cases.push_back(draw_case(nominal(), seed, number));
    return cases;
}

TEST(CaseDraw, SameSeedAndNumber_IsTheSameCase) {
    for (std::size_t number = 0; number < 40; ++number) {
        const Case a = draw_case(nominal(), 7, number), b = draw_case(nominal(), 7, number);
        EXPECT_EQ(a.campaign_seed, b.campaign_seed);
        EXPECT_EQ(a.without, b.without);
        ASSERT_EQ(a.label.effects.size(), b.label.effects.size());
        for (std::size_t k = 0; k < a.label.effects.size(); ++k) {
            EXPECT_EQ(a.label.effects[k].effect, b.label.effects[k].effect);
            EXPECT_EQ(a.label.effects[k].size, b.label.effects[k].size);
        }
        EXPECT_NE(a.campaign_seed, draw_case(nominal(), 8, number).campaign_seed);
    }
}

TEST(CaseDraw, TenCasesInARow_AreOfAllKinds) {
    for (const std::uint64_t seed : {1, 2, 3}) {
        std::map<CaseKind, int> kinds;
        for (std::size_t number = 30; number < 40; ++number) ++kinds[kind_of_case(seed, number)];
        EXPECT_EQ(kinds[CaseKind::none], 2);
        EXPECT_EQ(kinds[CaseKind::one], 4);
        EXPECT_EQ(kinds[CaseKind::two], 2);
        EXPECT_EQ(kinds[CaseKind::withheld], 1);
        EXPECT_EQ(kinds[CaseKind::unlisted], 1);
    }
}

TEST(CaseDraw, OneRound_MeetsEveryClassOnce) {
    const std::size_t classes = listed_classes().size();
    for (const CaseKind kind : {CaseKind::one, CaseKind::two, CaseKind::withheld}) {
        std::map<std::string, std::size_t> met;
        for (const Case& drawn : cases_of(kind, 5, 2 * classes))
            ++met[drawn.label.effects.front().class_name];
        EXPECT_EQ(met.size(), classes);
        for (const auto& [name, count] : met) EXPECT_EQ(count, 2u) << name_of(kind) << ' ' << name;
    }
    std::set<std::string> unlisted;
    for (const Case& drawn : cases_of(CaseKind::unlisted, 5, unlisted_effects().size()))
        unlisted.insert(drawn.label.effects.front().effect);
    EXPECT_EQ(unlisted.size(), unlisted_effects().size());
}

TEST(CaseDraw, EffectsOfTheCatalogue_AreAllThatShowWithoutFrames) {
    std::set<std::string_view> missing;
    for (const plant::Effect* effect : plant::effect_catalogue())
        if (effect->block != "camera.image") missing.insert(effect->name);
    for (const EffectDraw& draw : listed_effects()) {
        EXPECT_NE(plant::find_effect(draw.effect), nullptr) << draw.effect;
        missing.erase(draw.effect);
    }
    EXPECT_TRUE(missing.empty()) << *missing.begin();
    for (const UnlistedEffect& effect : unlisted_effects())
        EXPECT_EQ(plant::find_effect(effect.name), nullptr) << effect.name;
}

TEST(CaseDraw, Sizes_ReachFromBelowTheFloorOrA300thToTheLargest) {
    double smallest_floors = 100.0, smallest_share = 1.0, largest_share = 0.0;
    for (const Case& drawn : cases_of(CaseKind::one, 3, 400)) {
        const TrueEffect& truth = drawn.label.effects.front();
        const auto way = std::ranges::find_if(listed_effects(), [&](const EffectDraw& other) {
            return other.effect == truth.effect && other.formula == truth.formula;
        });
        ASSERT_NE(way, listed_effects().end());
        EXPECT_DOUBLE_EQ(truth.expected_floors, truth.size / way->floor_size);
        smallest_floors = std::min(smallest_floors, truth.expected_floors);
        smallest_share = std::min(smallest_share, truth.size / way->largest);
        largest_share = std::max(largest_share, truth.size / way->largest);
    }
    EXPECT_GE(smallest_floors, 0.7);
    EXPECT_LE(smallest_floors, 0.9);
    EXPECT_GE(smallest_share, 1.0 / 300.0);
    EXPECT_LE(smallest_share, 1.0 / 250.0);
    EXPECT_GE(largest_share, 0.95);
    EXPECT_LE(largest_share, 1.0);
}

TEST(CaseDraw, Pairs_AreOfTwoClassesInOneBlockOrTwo) {
    std::size_t same_block = 0;
    const std::vector<Case> pairs = cases_of(CaseKind::two, 9, 200);
    for (const Case& drawn : pairs) {
        ASSERT_EQ(drawn.label.effects.size(), 2u);
        const TrueEffect &a = drawn.label.effects[0], &b = drawn.label.effects[1];
        EXPECT_TRUE(can_be_together(a.class_name, b.class_name)) << a.effect << ' ' << b.effect;
        same_block += a.block == b.block ? 1 : 0;
    }
    EXPECT_GE(same_block, pairs.size() / 3);
    EXPECT_LE(same_block, pairs.size() / 2);
    EXPECT_FALSE(can_be_together("presliding", "coulomb_friction"));
    EXPECT_FALSE(can_be_together("airflow", "airflow"));
}

TEST(CaseDraw, Withheld_LeavesTheWholeClassOut) {
    for (const Case& drawn : cases_of(CaseKind::withheld, 4, listed_classes().size())) {
        ASSERT_EQ(drawn.without.size(), 1u);
        EXPECT_EQ(gap::class_of(drawn.without.front()), drawn.label.effects.front().class_name);
    }
}

TEST(Campaign, Recordings_DoNotCarryTheLabel) {
    const std::vector<CampaignRun> runs = campaign_runs(nominal());
    EXPECT_EQ(runs.size(), 16u);
    const auto rest = std::ranges::find(runs, "rest-1", &CampaignRun::name);
    ASSERT_NE(rest, runs.end());
    const Case plain = cases_of(CaseKind::none, 6, 1).front();
    const Recording expected = record_run(nominal(), plain.true_rig, *rest, plain.campaign_seed);
    std::vector<Case> others = cases_of(CaseKind::unlisted, 6, unlisted_effects().size());
    others.push_back(cases_of(CaseKind::one, 6, 1).front());
    for (const Case& drawn : others) {
        const Recording recording = record_run(nominal(), drawn.true_rig, *rest, drawn.campaign_seed);
        EXPECT_EQ(recording.name, expected.name);
        EXPECT_EQ(recording.rig, expected.rig);
        EXPECT_EQ(recording.experiment, expected.experiment);
        EXPECT_EQ(recording.tick_s, expected.tick_s);
        EXPECT_EQ(recording.rows.size(), expected.rows.size());
        EXPECT_TRUE(recording.frames.empty());
    }
}

}  // namespace
}  // namespace fidservo::selfcheck
