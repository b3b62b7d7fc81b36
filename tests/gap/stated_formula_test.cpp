// SPDX-License-Identifier: GPL-3.0-or-later
// A formula that the rig file states is asked whether its parameters are still right.
#include "gap/candidates/candidate.h"
#include "gap/diagnose.h"
#include "plant/effects/catalogue.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::gap {
namespace {

using testing::recordings_of;

/// Drag that falls off where the carriage is fast: a size and a shape.
StatedEffect stated_drag(double size_V, double speed_mm_per_s) {
    FormulaEffect text;
    text.name = "own_drag";
    text.block = text.acts_on = "macro.friction";
    text.formula = "size * tanh(speed / width)";
    text.parameters = {{.name = "size", .unit = "V", .low = 0.0, .high = 2.0, .typical = 0.1},
                       {.name = "width",
                        .unit = "mm/s",
                        .low = 5.0,
                        .high = 500.0,
                        .vanishing = 60.0,
                        .typical = 60.0,
                        .role = "shape"}};
    return {text.name, {{"size", size_V}, {"width", speed_mm_per_s}}, text};
}

Rig rig_with(const StatedEffect& effect) {
    Rig rig = reference_rig();
    rig.effects = {effect};
    return rig;
}

Evidence evidence_of(const StatedEffect& by_file, const StatedEffect& truth) {
    return {rig_with(by_file),
            recordings_of({}, {"macro-pulses", "macro-square", "macro-sweep"}, rig_with(truth))};
}

const std::vector<std::string> friction{"own_drag", "viscous_friction", "coulomb_friction", "drive_gain",
                                        "payload"};

TEST(SlowStatedFormula, OtherSizeAndShape_AreFoundByItsName) {
    const StatedEffect by_file = stated_drag(0.2, 60.0);
    const Diagnosis diagnosis = diagnose(evidence_of(by_file, stated_drag(0.35, 110.0)),
                                         {.only = friction, .without = {}, .selection = {}});
    ASSERT_EQ(diagnosis.effects.size(), 1u);
    const FoundEffect& found = diagnosis.effects.front();
    EXPECT_EQ(found.effect, "own_drag");
    EXPECT_EQ(diagnosis.verdict, Verdict::explained);
    ASSERT_EQ(found.parameters.size(), 2u);
    EXPECT_NEAR(found.parameters[0].value, 0.35, 0.02);
    EXPECT_NEAR(found.parameters[1].value, 110.0, 10.0);
    EXPECT_THAT(
        diagnosis.notes,
        ::testing::Contains("own_drag: the rig file states it; these values take the place of size = 0.2, "
                            "width = 60"));
}

TEST(SlowStatedFormula, ValuesThatAreRight_AreNoGap) {
    const StatedEffect by_file = stated_drag(0.2, 60.0);
    const Diagnosis diagnosis =
        diagnose(evidence_of(by_file, by_file), {.only = friction, .without = {}, .selection = {}});
    EXPECT_EQ(diagnosis.verdict, Verdict::no_gap);
}

TEST(StatedFormula, LeftOut_IsNotTried) {
    const StatedEffect by_file = stated_drag(0.2, 60.0);
    const Evidence evidence = evidence_of(by_file, by_file);
    const auto is_tried = [&](const std::vector<std::string>& without) {
        return std::ranges::any_of(candidates(evidence, {}, without), [](const Candidate& candidate) {
            return candidate.effect->name == "own_drag";
        });
    };
    EXPECT_TRUE(is_tried({}));
    EXPECT_FALSE(is_tried({"own_drag"}));
}

}  // namespace
}  // namespace fidservo::gap
