// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/at_once.h"

#include "tests/gap/effects.h"
#include "tests/gap/simulated_campaign.h"

#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::effects;
using ::testing::IsSupersetOf;

/// Play is no force, and while it is unknown the forces of the other effects balance nothing.
TEST(SlowAtOnce, PlayThatHidesForces_IsFound_AndTheForcesBesideIt) {
    const Evidence evidence = testing::campaign(effects({"backlash:width_um=800", "payload:mass_factor=1.05",
                                                         "viscous_friction:damping_V_s_per_mm=5e-5"}),
                                                {"macro-sweep", "macro-square", "macro-pulses"});
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    Search search(evidence, all, {});
    Chain chain{{}, search.nothing()};
    Aside aside;
    std::vector<Trial> alone;
    explain_at_once(search, chain, aside, alone);
    std::vector<std::string_view> names;
    for (const Choice& choice : chain.choices) names.push_back(choice.candidate->effect->name);
    EXPECT_THAT(names, IsSupersetOf({"backlash", "payload", "viscous_friction"}));
    EXPECT_FALSE(search.far_off(chain.fitted)[index_of(Signal::encoder)]);
}

TEST(FurthestOff, IsTheSignalWithTheLargestGap_AndNoneAtTheFloor) {
    const Evidence evidence = testing::campaign(effects({"hall_offset:offset_V=0.01"}), {"micro-steps"});
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    const Search search(evidence, all, {});
    const CrossFit nothing = search.nothing();
    EXPECT_EQ(search.furthest_off(nothing), Signal::hall);
    CrossFit explained{
        .of_half = {effects({"hall_offset:offset_V=0.01"}), effects({"hall_offset:offset_V=0.01"})},
        .mean_squares = {}};
    search.judge(explained);
    EXPECT_EQ(search.furthest_off(explained), std::nullopt);
}

}  // namespace

}  // namespace fidservo
