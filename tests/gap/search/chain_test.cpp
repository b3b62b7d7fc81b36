// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/chain.h"

#include "tests/gap/chain_of.h"
#include "tests/gap/effects.h"
#include "tests/gap/simulated_campaign.h"

#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::chain_of;
using testing::effects;

std::string_view first_name_in_plain_forms(const Hypothesis& truth, const Hypothesis& found) {
    const Evidence evidence = testing::campaign(truth, {"macro-sweep", "macro-square"});
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    const Search search(evidence, all, {});
    const Chain chain = in_plain_forms(search, chain_of(search, all, found));
    EXPECT_EQ(chain.fitted.of_half[0].front().effect, chain.choices.front().candidate->effect);
    return chain.choices.front().candidate->effect->name;
}

TEST(PlainForms, FrictionThatIsTheSameInBothDirections_IsViscousFriction) {
    EXPECT_EQ(first_name_in_plain_forms(
                  effects({"viscous_friction:damping_V_s_per_mm=0.0009"}),
                  effects({"friction_asymmetry:right_V_s_per_mm=0.000901,left_V_s_per_mm=0.000899"})),
              "viscous_friction");
}

/// Beside a wave that is not known well, the bend of bristles removes no share of the gap.
TEST(PlainForms, BristlesThatBend_KeepTheirNameBesideALargerGap) {
    EXPECT_EQ(first_name_in_plain_forms(effects({"presliding:level_V=0.0064,distance_um=150",
                                                 "cogging:amplitude_V=0.12,period_mm=6.08"}),
                                        effects({"presliding:level_V=0.0064,distance_um=150",
                                                 "cogging:amplitude_V=0.13,period_mm=6.08"})),
              "presliding");
}

TEST(PlainForms, FrictionThatDiffersByDirection_KeepsItsName) {
    const Hypothesis truth = effects({"friction_asymmetry:right_V_s_per_mm=0.0005,left_V_s_per_mm=0.0009"});
    EXPECT_EQ(first_name_in_plain_forms(truth, truth), "friction_asymmetry");
}

}  // namespace

}  // namespace fidservo
