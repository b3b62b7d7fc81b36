// SPDX-License-Identifier: GPL-3.0-or-later
// Which effects of an explanation are needed.
#include "gap/search/exchange.h"

#include "tests/gap/chain_of.h"
#include "tests/gap/effects.h"
#include "tests/gap/simulated_campaign.h"

#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::chain_of;
using testing::effects;
using ::testing::ElementsAre;

std::vector<std::string_view> needed_of(const Hypothesis& truth, const Hypothesis& found) {
    const Evidence evidence = testing::campaign(truth, {"macro-sweep", "macro-pulses", "micro-steps"});
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    const Search search(evidence, all, {});
    std::vector<std::string_view> names;
    for (const Choice& choice : without_needless(search, evidence, chain_of(search, all, found)).choices)
        names.push_back(choice.candidate->effect->name);
    return names;
}

TEST(WithoutNeedless, EffectsThatTakeNothingAway_AreLeftOut) {
    EXPECT_THAT(needed_of(effects({"drive_offset:offset_V=0.02", "hall_gain:factor=1.01"}),
                          effects({"viscous_friction:damping_V_s_per_mm=1e-7", "drive_offset:offset_V=0.02",
                                   "drive_gain:factor=1.00001", "hall_gain:factor=1.01"})),
                ElementsAre("drive_offset", "hall_gain"));
}

TEST(WithoutNeedless, WhereAGapIsLeft_NothingIsLeftOut) {
    EXPECT_THAT(needed_of(effects({"drive_offset:offset_V=0.02", "payload:mass_factor=1.5"}),
                          effects({"drive_offset:offset_V=0.02", "drive_gain:factor=1.00001"})),
                ElementsAre("drive_offset", "drive_gain"));
}

Chain unhindered(const Hypothesis& truth, const Hypothesis& found) {
    const Evidence evidence = testing::campaign(truth, {"macro-sweep", "macro-pulses", "micro-steps"});
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    const Search search(evidence, all, {});
    return without_hindrances(search, chain_of(search, all, found));
}

TEST(WithoutHindrances, EffectBesideWhichTheRestIsOffItsOptimum_IsLeftOut) {
    const Chain chain =
        unhindered(effects({"payload:mass_factor=1.2"}),
                   effects({"payload:mass_factor=1.15", "viscous_friction:damping_V_s_per_mm=1e-5"}));
    ASSERT_EQ(chain.choices.size(), 1u);
    EXPECT_EQ(chain.choices[0].candidate->effect->name, "payload");
    EXPECT_NEAR(chain.fitted.of_half[0][0].values[0], 1.2, 0.005);
}

TEST(WithoutHindrances, EffectsThatAreNeeded_StayAndSayWhatIsLeftWithoutThem) {
    const Hypothesis truth = effects({"payload:mass_factor=1.2", "hall_gain:factor=1.01"});
    const Chain chain = unhindered(truth, truth);
    ASSERT_EQ(chain.choices.size(), 2u);
    for (const Choice& choice : chain.choices) EXPECT_GT(choice.left_out.loss, chain.fitted.loss);
}

}  // namespace

}  // namespace fidservo
