// SPDX-License-Identifier: GPL-3.0-or-later
// A carriage that is explained by the balance of its forces, and chains that differ in their carriage.
#include "gap/search/carriage_at_once.h"

#include "gap/fit/gap_size.h"
#include "tests/gap/chain_of.h"
#include "tests/gap/simulated_campaign.h"

#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;
using testing::campaign;
using testing::chain_of;
using testing::effects;
using ::testing::UnorderedElementsAre;

std::vector<std::string_view> names_of(const Chain& chain) {
    std::vector<std::string_view> names;
    for (const Choice& choice : chain.choices) names.push_back(choice.candidate->effect->name);
    return names;
}

TEST(SlowCarriageAtOnce, SeveralForces_AreFoundTogether) {
    const Evidence evidence =
        campaign(effects({"viscous_friction:damping_V_s_per_mm=0.001", "drive_offset:offset_V=0.03",
                          "cogging:amplitude_V=0.08,period_mm=9,phase_rad=0.7"}),
                 {"macro-sweep", "macro-pulses"});
    const std::vector<std::string> only{"viscous_friction", "drive_offset", "cogging", "payload"};
    const std::vector<Candidate> all = candidates(evidence, only, {});
    Search search(evidence, all, {});
    Chain chain{{}, search.nothing()};
    Aside aside;
    std::vector<Trial> alone;
    explain_carriage(search, chain, aside, alone);
    EXPECT_THAT(names_of(chain), UnorderedElementsAre("viscous_friction", "drive_offset", "cogging"));
    EXPECT_LT(search.typical_floors(chain.fitted, Signal::encoder), least_floors);
}

TEST(CarriageAtOnce, WithoutTheCarriage_EffectsOfItsReadingStay) {
    const Evidence evidence = campaign({}, {"macro-pulses", "micro-steps"});
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    const Search search(evidence, all, {});
    const Chain chain =
        chain_of(search, all,
                 effects({"drive_gain:factor=1.01", "encoder_scale:factor=1.001", "hall_gain:factor=1.01"}));
    EXPECT_THAT(names_of(without_carriage(search, chain)),
                UnorderedElementsAre("encoder_scale", "hall_gain"));
}

TEST(CarriageAtOnce, WithTheCarriageOfAnother_WireAndSensorsStay) {
    const Evidence evidence = campaign({}, {"macro-pulses", "micro-steps"});
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    const Search search(evidence, all, {});
    const Chain chain = chain_of(search, all, effects({"drive_gain:factor=1.01", "hall_gain:factor=1.01"})),
                other =
                    chain_of(search, all, effects({"payload:mass_factor=1.05", "hall_offset:offset_V=0.01"}));
    const Chain both = with_carriage_of(search, chain, other);
    EXPECT_THAT(names_of(both), UnorderedElementsAre("payload", "hall_gain"));
    EXPECT_EQ(both.fitted.of_half[0].size(), 2U);
}

}  // namespace
}  // namespace fidservo
