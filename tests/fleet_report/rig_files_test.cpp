// SPDX-License-Identifier: GPL-3.0-or-later
// Units whose values count from two rig files.
#include "src/fleet/report/findings.h"
#include "src/fleet/report/judgement_words.h"
#include "tests/fleet_report/drawn_fleet.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::fleet {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr std::uint64_t seed = 41'500;

/// Twenty units that no batch tells apart, with a deviation of backlash.
DrawnFleet twenty_units(double (*floors)(std::size_t unit)) {
    DrawnFleet fleet;
    fleet.seed = seed;
    fleet.units = 20;
    fleet.batches = 1;
    fleet.truth = [=](std::size_t effect, std::size_t unit, std::size_t) {
        return effect == 1 ? floors(unit) : 0.0;
    };
    return fleet;
}

/// The second rig file states what the first one lacks: units of the first have 4 floors, those of the second
/// nothing.
TEST(RigFiles, UnitsOfAnotherFile_AreNotToldAsOff) {
    const DrawnFleet fleet = twenty_units([](std::size_t unit) { return unit % 2 == 0 ? 4.0 : 0.0; });
    std::vector<FleetResult> results = draw(fleet);
    for (std::size_t k = 0; k < results.size(); ++k)
        if (k % 2 == 1) results[k].rig_content = std::string(64, 'b');
    const FleetFindings findings = findings_of(results);
    ASSERT_THAT(findings.judgements, SizeIs(1)) << "seed " << seed;
    const Judgement& judgement = findings.judgements.front();
    EXPECT_EQ(judgement.group, "rig file aaaaaaaaaaaa");
    EXPECT_TRUE(judgement.is_by_rig_file);
    EXPECT_THAT(matter_sentence(findings, judgement), HasSubstr("another rig file than the others"));
    EXPECT_THAT(what_to_do(findings, judgement).front(), HasSubstr("with one rig file"));
    const QuantityFindings& backlash = findings.quantities[judgement.quantity];
    EXPECT_NEAR(backlash.population.mean, 0.0, 1.0) << "of all units it would be 2";
}

TEST(RigFiles, OneUnitOfAFileOfItsOwn_IsNotToBeAdjusted) {
    const DrawnFleet fleet = twenty_units([](std::size_t unit) { return unit == 7 ? 8.0 : 0.0; });
    std::vector<FleetResult> results = draw(fleet);
    for (std::size_t k = 7; k < results.size(); k += fleet.units)
        results[k].rig_content = std::string(64, 'b');
    const FleetFindings findings = findings_of(results);
    ASSERT_THAT(findings.judgements, SizeIs(1)) << "seed " << seed;
    EXPECT_TRUE(findings.judgements.front().is_by_rig_file);
}

}  // namespace
}  // namespace fidservo::fleet
