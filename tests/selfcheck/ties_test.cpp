// SPDX-License-Identifier: GPL-3.0-or-later
// What is counted of ties that were settled.
#include "src/selfcheck/ties.h"

#include "src/selfcheck/tally/tie_figures.h"

#include <array>

#include <gtest/gtest.h>

namespace fidservo::selfcheck {
namespace {

Settlement settlement(bool is_resolved) {
    return {
        .experiment = "designed", .log_odds = 9.0, .is_resolved = is_resolved, .named = {"coulomb_friction"}};
}

Outcome with(std::optional<Settlement> by_design, std::optional<Settlement> by_list) {
    Outcome outcome;
    outcome.tie = Tie{{"coulomb_friction|presliding"}, true, std::move(by_design), std::move(by_list), 1.0};
    return outcome;
}

TEST(Ties, ThoseWithADesignedExperiment_Count) {
    const std::array outcomes{with(settlement(true), settlement(false)), with(settlement(true), {}),
                              with(settlement(false), settlement(true)), with({}, {}), Outcome{}};
    const std::vector<ShareFigure> shares = tie_shares(outcomes);
    ASSERT_EQ(shares.size(), 2U);
    EXPECT_EQ(shares[0].share.hits, 2U);
    EXPECT_EQ(shares[0].share.of, 3U);
    EXPECT_EQ(shares[1].share.hits, 1U);
    EXPECT_EQ(shares[1].share.of, 3U);
}

TEST(Ties, Words_SayWhatWasTiedAndWhatIsLeft) {
    EXPECT_EQ(
        words_of(*with(settlement(true), {}).tie),
        "tie coulomb_friction|presliding; by design: designed resolves it: coulomb_friction; by the list: "
        "none\n");
}

TEST(Ties, DiagnosisWithoutOne_IsLeft) {
    EXPECT_FALSE(settle_tie({}, {}, {}, {}, {}).has_value());
}

}  // namespace
}  // namespace fidservo::selfcheck
