// SPDX-License-Identifier: GPL-3.0-or-later
// Changes on the same date, and the rig file that cures what all units share.
#include "src/fleet/report/groups.h"

#include "core/rig.h"
#include "src/files/rig/rig_file.h"
#include "src/fleet/report/cured_rig.h"
#include "src/fleet/report/findings.h"
#include "src/fleet/report/judgement_words.h"
#include "tests/fleet_report/drawn_fleet.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::fleet {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Half of the units step by ten floors, each in a week of its own or all in the tenth; a technician records
/// one unit after the other.
std::vector<FleetResult> stepping(bool together) {
    DrawnFleet fleet;
    fleet.units = 8;
    fleet.weeks = 20;
    fleet.batches = 1;
    fleet.truth = [=](std::size_t effect, std::size_t unit, std::size_t week) {
        const std::size_t onset = together ? 10 : 4 + 3 * unit;
        return effect == 1 && unit < 4 && week >= onset ? 10.0 : 0.0;
    };
    std::vector<FleetResult> results = draw(fleet);
    constexpr std::int64_t five_minutes_s = 300;
    for (std::size_t k = 0; k < results.size(); ++k)
        *results[k].recorded_at_s += five_minutes_s * static_cast<std::int64_t>(k % fleet.units);
    return results;
}

TEST(ChangeClusters, UnitsThatAreRecordedOneAfterTheOther_HaveChangedOnTheSameDate) {
    const std::vector<FleetResult> results = stepping(true);
    const FleetFindings findings = findings_of(results);
    const auto change = std::ranges::find(findings.judgements, Matter::step, &Judgement::matter);
    ASSERT_NE(change, findings.judgements.end());
    EXPECT_EQ(change->units.size(), 4U);
    EXPECT_LT(change->since->earliest_s, change->since->likeliest_s);
    EXPECT_LE(change->since->likeliest_s, change->since->latest_s);
}

TEST(ChangeClusters, UnitsThatChangeInDifferentWeeks_AreToldApart) {
    const FleetFindings findings = findings_of(stepping(false));
    for (const Judgement& judgement : findings.judgements) {
        if (judgement.matter != Matter::step) continue;
        EXPECT_EQ(judgement.units.size(), 1U);
    }
}

/// A named Stribeck friction in every diagnosis of ten units.
std::vector<FleetResult> all_with_stribeck(bool agree) {
    DrawnFleet fleet;
    fleet.units = 10;
    fleet.weeks = 6;
    std::vector<FleetResult> results = draw(fleet);
    for (std::size_t k = 0; k < results.size(); ++k) {
        FleetResult& result = results[k];
        result.effects = {{.effect = "stribeck_friction",
                           .block = "macro.friction",
                           .probability = 0.97,
                           .gap_removed = 0.99,
                           .gap_alone = 10.0,
                           .parameters = {{"level_V", "V", 0.2 + 1e-4 * static_cast<double>(k % 3), 1e-3},
                                          {"speed_mm_per_s", "mm/s",
                                           agree ? 60.0 : 5.0 + 3.0 * static_cast<double>(k), 1.0}},
                           .indistinguishable_from = {}}};
    }
    return results;
}

TEST(CuredRig, StatesAnEffectWhole) {
    const fidservo::testing::TemporaryFolder folder;
    const std::vector<FleetResult> results = all_with_stribeck(true);
    const CuredRig cured =
        write_cured_rig(folder / "cured.yaml", reference_rig_file(), results, findings_of(results));
    EXPECT_TRUE(cured.is_written);
    EXPECT_THAT(cured.left_out, IsEmpty());
    const Rig rig = load_rig(folder / "cured.yaml");
    ASSERT_EQ(rig.effects.size(), 1U);
    const auto value = [&](const std::string& name) {
        return std::ranges::find(rig.effects.front().parameters, name, &StatedEffect::Parameter::name)->value;
    };
    EXPECT_NEAR(value("level_V"), 0.2, 1e-3);
    EXPECT_NEAR(value("speed_mm_per_s"), 60.0, 1e-6);
}

TEST(CuredRig, EffectWithAnotherShapeInEachUnit_IsNoCure_AndAnOldFileGoes) {
    const fidservo::testing::TemporaryFolder folder;
    const std::vector<FleetResult> agreeing = all_with_stribeck(true), results = all_with_stribeck(false);
    (void)write_cured_rig(folder / "cured.yaml", reference_rig_file(), agreeing, findings_of(agreeing));
    const CuredRig cured =
        write_cured_rig(folder / "cured.yaml", reference_rig_file(), results, findings_of(results));
    EXPECT_FALSE(cured.is_written);
    EXPECT_THAT(cured.left_out, ElementsAre("stribeck_friction"));
    EXPECT_FALSE(std::filesystem::exists(folder / "cured.yaml"));
}

TEST(JudgementWords, UnitThatAgreesWithTheRigFile_IsNotToBeAdjusted) {
    DrawnFleet fleet;
    fleet.units = 20;
    fleet.weeks = 8;
    fleet.batches = 1;
    fleet.truth = [](std::size_t effect, std::size_t unit, std::size_t) {
        return effect == 1 && unit != 7 ? 8.0 : 0.0;
    };
    const FleetFindings findings = findings_of(draw(fleet));
    const auto odd = std::ranges::find(findings.judgements, Whose::unit, &Judgement::whose);
    ASSERT_NE(odd, findings.judgements.end());
    EXPECT_EQ(findings.units[odd->units.front()].name, "P-0008");
    EXPECT_THAT(matter_sentence(findings, *odd), HasSubstr("differs from what the other units have by"));
    EXPECT_THAT(matter_sentence(findings, *odd), Not(HasSubstr("off the rig file")));
    EXPECT_THAT(what_to_do(findings, *odd).front(), HasSubstr("Adjust nothing here"));
}

TEST(JudgementWords, OneUnitThatIsOff_IsToldAsWhatItsDiagnosesName) {
    DrawnFleet fleet;
    fleet.units = 1;
    fleet.weeks = 6;
    fleet.truth = [](std::size_t effect, std::size_t, std::size_t) { return effect == 1 ? 8.0 : 0.0; };
    const FleetFindings findings = findings_of(draw(fleet));
    EXPECT_THAT(findings.judgements, IsEmpty());
    EXPECT_THAT(nothing_stands_out(findings), HasSubstr("fewer than three units"));
    EXPECT_THAT(nothing_stands_out(findings), HasSubstr("P-0001"));
}

}  // namespace
}  // namespace fidservo::fleet
