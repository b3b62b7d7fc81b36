// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/rig.h"
#include "src/diagnose/report/chain_drawing.h"
#include "src/diagnose/report/waterfall.h"
#include "src/diagnose/words.h"
#include "tests/diagnose/well_formed.h"
#include "tests/reference_rig.h"

#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::diagnose {
namespace {

using ::fidservo::testing::nesting_fault;
using ::testing::HasSubstr;
using ::testing::Not;

gap::Diagnosis two_effects() {
    gap::Diagnosis diagnosis;
    diagnosis.verdict = gap::Verdict::explained;
    diagnosis.signals = {{gap::Signal::encoder, 9.0, 0.3, 0.3}, {gap::Signal::hall, 0.6, 0.6, 0.6}};
    diagnosis.gap = {10.0, 1.02};
    diagnosis.where = {{"macro.friction", 0.97}, {"macro.drive", 0.2}, {"micro.hall", 0.01}};
    diagnosis.effects.resize(2);
    diagnosis.effects[0].effect = "stribeck_friction";
    diagnosis.effects[0].block = "macro.friction";
    diagnosis.effects[0].gap_removed = 0.5;
    diagnosis.effects[1].effect = "drive_gain";
    diagnosis.effects[1].block = "macro.drive";
    diagnosis.effects[1].gap_removed = 0.9996;
    return diagnosis;
}

TEST(Chain, AccusedBlock_IsMarkedAndNoOther) {
    const std::string svg = chain_drawing_svg(reference_rig(), two_effects());
    EXPECT_EQ(nesting_fault(svg), "");
    EXPECT_THAT(svg, HasSubstr("class=\"block accused\" data-block=\"macro.friction\""));
    EXPECT_THAT(svg, HasSubstr("class=\"block suspect\" data-block=\"macro.drive\""));
    EXPECT_THAT(svg, HasSubstr("class=\"block\" data-block=\"micro.hall\""));
    EXPECT_THAT(svg, HasSubstr("97.0 %"));
    EXPECT_THAT(svg, HasSubstr("stribeck friction"));
}

TEST(Chain, Boundary_ShowsTheGapInFloorsAndUnits) {
    const std::string svg = chain_drawing_svg(reference_rig(), two_effects());
    EXPECT_THAT(svg, HasSubstr("class=\"boundary size-4\" data-signal=\"encoder\""));
    EXPECT_THAT(svg, HasSubstr("30.0 fl \u00b7 450 \u00b5m"));
    EXPECT_THAT(svg, HasSubstr("1.00 fl \u00b7 15.0 \u00b5m"));
    EXPECT_THAT(svg, HasSubstr("class=\"boundary unjudged\" data-signal=\"macro_command\""));
}

TEST(Chain, RigWithCarriageAlone_HasNoOtherParts) {
    Rig rig = reference_rig();
    rig.micro.reset();
    rig.camera.reset();
    rig.macro.pd.reset();
    rig.macro.pid.reset();
    const std::string svg = chain_drawing_svg(rig, two_effects());
    EXPECT_THAT(svg, HasSubstr("data-block=\"macro.encoder\""));
    for (const char* absent : {"micro.", "camera.", "data-block=\"plate\"", "data-block=\"controller\""})
        EXPECT_THAT(svg, Not(HasSubstr(absent)));
}

TEST(Waterfall, Steps_FollowFromTheSharesRemoved) {
    const std::vector<double> steps = gap_after_steps(two_effects());
    ASSERT_EQ(steps.size(), 2u);
    EXPECT_NEAR(steps[0], std::sqrt(1.0 + 0.5 * 99.0), 1e-12);
    EXPECT_EQ(steps[1], 1.02) << "the diagnosis's own gap after, not one from a rounded share";
}

TEST(Waterfall, Drawing_NamesStepsAndFloor) {
    const std::string svg = waterfall_svg(two_effects());
    EXPECT_EQ(nesting_fault(svg), "");
    for (const char* expected : {"Rig file as it is", "+ stribeck friction", "+ drive gain", ">7.11<",
                                 ">10.0<", ">1.02<", "50.0 % removed", "noise floor"})
        EXPECT_THAT(svg, HasSubstr(expected));
}

TEST(Waterfall, GapBelowTheFloor_StaysInTheDrawing) {
    gap::Diagnosis diagnosis = two_effects();
    for (const double after : {0.39, 0.0}) {
        diagnosis.gap = {0.4, after};
        for (const char* outside : {"x=\"-", "inf", "nan"})
            EXPECT_THAT(waterfall_svg(diagnosis), Not(HasSubstr(outside))) << after;
    }
}

}  // namespace
}  // namespace fidservo::diagnose
