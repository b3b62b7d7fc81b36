// SPDX-License-Identifier: GPL-3.0-or-later
// Which effects meet in the same signals, and what a search remembers of them.
#include "gap/candidates/coupling.h"

#include "gap/search/search_memory.h"
#include "tests/gap/effects.h"

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::effects;

const plant::Effect& effect(std::string_view name) {
    return *plant::find_effect(name);
}

TEST(Coupling, WireAndCarriage_DoNotMeet_ButWireAndHallSensorDo) {
    EXPECT_FALSE(meet(teachers_of(effect("airflow")), teachers_of(effect("drive_gain"))));
    EXPECT_TRUE(meet(teachers_of(effect("airflow")), teachers_of(effect("hall_gain"))));
    EXPECT_TRUE(meet(teachers_of(effect("hall_gain")), teachers_of(effect("encoder_scale"))));
}

TEST(Coupling, WhatMovesTheCarriage_ShowsInTheTags_ButIsNotLearntThere) {
    const auto tag = index_of(Signal::tag);
    EXPECT_FALSE(teachers_of(effect("drive_gain"))[tag]);
    EXPECT_TRUE(reached_by(effects({"drive_gain:factor=1.1"}))[tag]);
    EXPECT_TRUE(teachers_of(effect("encoder_scale"))[tag]);
}

TEST(Coupling, AHypothesisHasTheEffectsOfItsSettings) {
    EXPECT_TRUE(has_effect(effects({"airflow:factor=0.9", "hall_gain"}), effect("hall_gain")));
    EXPECT_FALSE(has_effect(effects({"airflow:factor=0.9"}), effect("hall_gain")));
    EXPECT_FALSE(has_effect({}, effect("hall_gain")));
}

TEST(Coupling, GoesFromEffectToEffect) {
    const Hypothesis chain =
        effects({"airflow:factor=0.9", "hall_gain:factor=1.1", "encoder_scale:factor=1.01"});
    EXPECT_EQ(coupled_with(chain, effect("heater_gain")), (Places{0, 1, 2}));
    const Hypothesis apart = effects({"airflow:factor=0.9", "encoder_scale:factor=1.01"});
    EXPECT_EQ(coupled_with(apart, effect("heater_gain")), Places{0});
    EXPECT_EQ(uncoupled_parts(chain), (std::vector<Places>{{0, 1, 2}}));
    EXPECT_EQ(uncoupled_parts(apart), (std::vector<Places>{{0}, {1}}));
}

TEST(Coupling, PartThatIsPutBack_ChangesNothingElse) {
    const Hypothesis whole =
        effects({"airflow:factor=0.9", "drive_gain:factor=1.1", "heater_gain:factor=1.2"});
    Hypothesis part = part_of(whole, {0, 2});
    ASSERT_EQ(part.size(), 2U);
    part[1].values[0] = 1.3;
    const Hypothesis changed = with_part(whole, {0, 2}, part);
    EXPECT_EQ(changed[0].values, whole[0].values);
    EXPECT_EQ(changed[1].values, whole[1].values);
    EXPECT_EQ(changed[2].values, std::vector{1.3});
}

TEST(SearchMemory, KnowsACandidateBesideTheSameValues_AndNoOthers) {
    SearchMemory memory(2);
    const std::array<Hypothesis, 2> base{effects({"airflow:factor=0.9"}), effects({"airflow:factor=0.91"})};
    Finding& first = memory.of(1, base);
    first.is_looked_at = true;
    EXPECT_FALSE(memory.of(0, base).is_looked_at);
    EXPECT_FALSE(memory.of(1, {base[0], base[0]}).is_looked_at);
    EXPECT_FALSE(memory.of(1, {}).is_looked_at);
    EXPECT_EQ(&memory.of(1, base), &first);
}

}  // namespace

}  // namespace fidservo
