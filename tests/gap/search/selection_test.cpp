// SPDX-License-Identifier: GPL-3.0-or-later
// What a selection of effects consists of: its choices, their order, and the cross fits on the way.
#include "gap/search/selection.h"

#include "gap/fit/gap_size.h"
#include "gap/search/growth.h"
#include "tests/gap/simulated_campaign.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;
using testing::campaign;
using testing::effects;

std::vector<Candidate> some(const Evidence& evidence, const std::vector<std::string>& names) {
    return candidates(evidence, names, {});
}

TEST(Selection, OfTwoEffects_TheLargerComesFirst_AndEveryStepIsJudged) {
    const Evidence evidence = campaign(effects({"drive_gain:factor=1.06", "hall_gain:factor=1.004"}),
                                       {"macro-pulses", "micro-steps"});
    const std::vector<Candidate> tried = some(evidence, {"drive_gain", "hall_gain"});
    const Selection selection = select(evidence, tried);
    ASSERT_EQ(selection.choices.size(), 2U);
    EXPECT_EQ(selection.choices[0].candidate->effect->name, "drive_gain");
    EXPECT_EQ(selection.choices[1].candidate->effect->name, "hall_gain");
    EXPECT_GT(selection.choices[0].gap_alone, selection.choices[1].gap_alone);
    ASSERT_EQ(selection.steps.size(), 3U);
    EXPECT_EQ(selection.ended, Ended::finished);
    for (std::size_t k = 1; k < selection.steps.size(); ++k) {
        EXPECT_EQ(selection.steps[k].of_half[0].size(), k);
        EXPECT_LT(selection.steps[k].loss, selection.steps[k - 1].loss);
    }
}

TEST(Selection, FittedToAllWindows_ItsValuesAreThoseOfTheRig) {
    const Evidence evidence = campaign(effects({"drive_gain:factor=1.06"}), {"macro-pulses"});
    const std::vector<Candidate> tried = some(evidence, {"drive_gain"});
    const Selection selection = select(evidence, tried);
    ASSERT_EQ(selection.choices.size(), 1U);
    const Fit fitted = fit_to_all(evidence, selection.steps.back());
    EXPECT_NEAR(fitted.hypothesis.front().values.front(), 1.06, 1e-3);
    EXPECT_GT(fitted.covariance(0, 0), 0.0);
}

TEST(Selection, RigAsItsFileSays_HasNoChoice) {
    const Evidence evidence = campaign({}, {"macro-pulses", "micro-steps"});
    const std::vector<Candidate> tried = some(evidence, {"drive_gain", "hall_gain"});
    const Selection selection = select(evidence, tried);
    EXPECT_TRUE(selection.choices.empty());
    EXPECT_EQ(selection.steps.size(), 1U);
}

TEST(Growth, EndsAtItsLargestNumberOfEffects) {
    const Evidence evidence = campaign(effects({"drive_gain:factor=1.06", "hall_gain:factor=1.02"}),
                                       {"macro-pulses", "micro-steps"});
    const std::vector<Candidate> tried = some(evidence, {"drive_gain", "hall_gain"});
    Search search(evidence, tried, {});
    Chain chain{{}, search.nothing()};
    std::vector<Trial> first_step;
    EXPECT_FALSE(grow(search, chain, {.most_effects = 1}, &first_step));
    EXPECT_EQ(chain.choices.size(), 1U);
    EXPECT_EQ(first_step.size(), 2U);
    EXPECT_FALSE(grow(search, chain, {.most_effects = 4}, nullptr));
    EXPECT_EQ(chain.choices.size(), 2U);
    EXPECT_TRUE(search.is_at_floor(chain.fitted));
}

}  // namespace
}  // namespace fidservo
