// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/at_once.h"

#include "tests/gap/effects.h"
#include "tests/gap/simulated_campaign.h"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::effects;
using ::testing::IsSupersetOf;

/// A budget of time for the search alone, by effort.
std::shared_ptr<const Budget> search_of(double search_s) {
    constexpr double endless_s = 1e6;
    return std::make_shared<const Budget>(search_s, endless_s, std::function<bool()>(), Seconds::by_effort);
}

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

/// Play is no force: no model balances it, however long it is sought.
TEST(SlowAtOnce, ForcesThatBalanceNothing_LeaveHalfOfTheTimeToTheRest) {
    constexpr double search_s = 4.0;
    const auto budget = search_of(search_s);
    const Evidence evidence(
        reference_rig(),
        testing::recordings_of(effects({"backlash:width_um=800", "cogging:amplitude_V=0.002,period_mm=4.6",
                                        "presliding:level_V=0.002"}),
                               {"macro-sweep", "macro-square", "macro-pulses"}),
        budget);
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    Search search(evidence, all, {});
    const CrossFit nothing = search.nothing();
    const auto spent_s = [&] { return static_cast<double>(budget->rows()) / rows_a_second; };
    const double before_s = spent_s();
    search.forces_beside(nothing);
    constexpr double one_prediction_s = 0.1;
    EXPECT_LT(spent_s() - before_s, 0.5 * (search_s - before_s) + one_prediction_s);
    EXPECT_NO_THROW(budget->check());
}

/// It is better than none, although nothing was fitted to predictions yet.
TEST(SlowAtOnce, ModelThatNoTimeIsLeftToFit_IsKeptAsForcesBalance) {
    constexpr double search_s = 3.0;
    const auto budget = search_of(search_s);
    const Evidence evidence(
        reference_rig(),
        testing::recordings_of(
            effects({"drive_offset:offset_V=0.009", "rail_patch:level_V=0.4,centre_mm=80,width_mm=8"}),
            {"macro-sweep", "macro-square", "macro-pulses"}),
        budget);
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    Search search(evidence, all, {});
    const CrossFit nothing = search.nothing();
    const Search::Together found = search.forces_beside(nothing);
    ASSERT_FALSE(found.candidates.empty());
    EXPECT_EQ(found.candidates.front()->effect->name, "rail_patch");
    EXPECT_LT(found.fitted.loss, nothing.loss);
}

/// Nothing that is tried moves the carriage as this wave does.
TEST(SlowAtOnce, TagsBesideACarriageThatIsFarOff_Wait) {
    const Evidence evidence =
        testing::campaign(effects({"cogging:amplitude_V=0.1,period_mm=6"}), {"integrated", "macro-pulses"});
    const std::vector<std::string> without{"cogging"};
    const std::vector<Candidate> all = candidates(evidence, {}, without);
    Search search(evidence, all, {});
    Chain chain{{}, search.nothing()};
    ASSERT_TRUE(search.off(chain.fitted)[index_of(Signal::tag)]);
    Aside aside;
    std::vector<Trial> alone;
    EXPECT_TRUE(explain_at_once(search, chain, aside, alone).do_tags_wait);
    const Hypothesis before = chain.fitted.of_half[0];
    explain_waiting_tags(search, chain);
    EXPECT_EQ(chain.fitted.of_half[0], before);
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
