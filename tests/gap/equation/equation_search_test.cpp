// SPDX-License-Identifier: GPL-3.0-or-later
// The search for an equation by itself, beside an explanation that names nothing.
#include "gap/equation/equation_search.h"

#include "gap/equation/equation.h"
#include "tests/gap/hidden_formula.h"
#include "tests/gap/nothing_named.h"
#include "tests/gap/simulated_campaign.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::gap {
namespace {

constexpr double tail = 0.01;

TEST(SlowEquationSearch, RigWithoutAGap_HasNone) {
    const Evidence evidence = testing::campaign({}, {"macro-pulses"});
    EXPECT_FALSE(search_equation(evidence, testing::nothing_named(evidence), "macro.friction",
                                 Signal::encoder, "of_test", tail)
                     .has_value());
}

/// A force that is no effect of the catalogue: bearings that turn harder at one end of the rail and easier at
/// the other.
TEST(SlowEquationSearch, ForceThatGrowsWithThePlace_IsFoundWithItsSlope) {
    constexpr double slope_V_per_mm = 5e-4;
    const Evidence evidence = testing::campaign(
        {testing::hidden_formula("macro.force", "macro.mechanics", "size * place", slope_V_per_mm)},
        {"macro-pulses", "macro-sweep"});
    const std::optional<ProposedEquation> found =
        equation_of(evidence, testing::nothing_named(evidence),
                    {.block = "macro.mechanics", .depends_on = {}, .text = {}}, 1, tail);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->equation.acts_on, "macro.force");
    EXPECT_THAT(found->equation.variables, ::testing::Contains("place"));
    EXPECT_GT(found->equation.gap_removed, 0.95);
    EXPECT_GT(found->equation.gap_removed_low, 0.9);
    ASSERT_EQ(found->equation.parameters.size(), 1U) << found->equation.formula;
    EXPECT_NEAR(found->equation.parameters.front().value, slope_V_per_mm, 0.05 * slope_V_per_mm);
}

}  // namespace
}  // namespace fidservo::gap
