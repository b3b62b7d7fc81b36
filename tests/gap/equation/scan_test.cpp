// SPDX-License-Identifier: GPL-3.0-or-later
// Single terms with large coefficients, where one of them is the truth.
#include "gap/equation/scan.h"

#include "gap/fit/score.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"
#include "tests/gap/nothing_named.h"
#include "tests/gap/simulated_campaign.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::gap {
namespace {

std::vector<Sketch> scanned_at(const Evidence& evidence, plant::Port port) {
    return scanned(evidence, testing::nothing_named(evidence), port,
                   terms_of(port, covered_ranges(evidence), std::array{5.0, 10.0}), 3);
}

/// Another temperature of transformation acts through the hysteresis, of which nothing is linear in it.
TEST(ScannedTerms, ShiftOfTheHysteresis_IsTheConstantTermOfItsSize) {
    const Evidence evidence =
        testing::campaign(testing::effects({"stress_shift:shift_degC=5,spring_degC_per_mm=0"}),
                          {"micro-steps", "micro-triangle"});
    const std::vector<Sketch> found = scanned_at(evidence, plant::Port::transformation);
    ASSERT_EQ(found.size(), 3U);
    const Sketch& best = found.front();
    ASSERT_EQ(best.terms.size(), 1U);
    const Hypothesis shift{plant::typical_setting(
        plant::effect_of(formula_of(best, plant::describe(best.port).blocks.front(), "shift_of_test")))};
    const Wanted hall = only_of(evidence.windows(), everything(evidence), only(Signal::hall));
    const double before = total_loss(evidence.windows(), hall, evidence.errors({}, hall)),
                 after = total_loss(evidence.windows(), hall, evidence.errors(shift, hall));
    EXPECT_LT(after, 0.1 * before);
    EXPECT_NEAR(std::abs(best.coefficients.front()) * best.terms.front().size, 5.0, 1e-9);
}

TEST(ScannedTerms, OfCarriageAndEncoder_AreNone) {
    const Evidence evidence = testing::campaign({}, {"micro-steps"});
    for (const plant::Port port : {plant::Port::force, plant::Port::friction, plant::Port::drive_voltage})
        EXPECT_TRUE(scanned_at(evidence, port).empty());
}

}  // namespace
}  // namespace fidservo::gap
