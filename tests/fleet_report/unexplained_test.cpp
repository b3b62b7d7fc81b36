// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/unexplained.h"

#include "src/fleet/report/database.h"
#include "src/fleet/report/findings.h"
#include "src/fleet/report/fleet_json.h"
#include "src/fleet/report/fleet_page.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fidservo::fleet {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// One diagnosis of a unit that nothing explains.
FleetResult left_with(const std::string& unit, double floors, const std::string& verdict = "unexplained") {
    FleetResult result;
    result.file = unit + ".json";
    result.campaign = "recordings/" + unit;
    result.unit = unit;
    result.rig_content = std::string(64, 'a');
    result.done = true;
    result.ended = "finished";
    result.verdict = verdict;
    result.gap_before = 12.0;
    result.gap_after = floors;
    result.unexplained = "macro.friction";
    return result;
}

std::string headline(const std::string& page) {
    const auto begin = page.find("<h1");
    return page.substr(begin, page.find("</h1>") - begin);
}

TEST(Unexplained, CampaignsOfOneRecordingEach_AreSaidFirstWithTheirSizes) {
    const Collected collected{
        {left_with("P-1", 11.0), left_with("P-2", 11.3), left_with("P-3", 10.9), left_with("P-4", 11.1)}, {}};
    const FleetFindings findings = findings_of(collected.results);
    const std::string page = fleet_page("fleet", collected, findings, {});
    EXPECT_THAT(headline(page), HasSubstr("4 of 4 units have gaps of up to 11.3 floors"));
    EXPECT_THAT(page, HasSubstr("All of them: a gap that nothing known explains"));
    EXPECT_THAT(page, HasSubstr("P-2: 11.3 floors are left of 12"));
    EXPECT_THAT(page, Not(HasSubstr("Nothing. Go on")));
    const auto json = nlohmann::json::parse(fleet_json(collected, findings, {}));
    EXPECT_EQ(json["unexplained"]["whose"], "all");
    EXPECT_EQ(json["unexplained"]["units"][0]["unit"], "P-2");
    EXPECT_EQ(json["unexplained"]["units"][0]["floors"], 11.3);
    EXPECT_FALSE(json["unexplained"]["to_do"].empty());
}

TEST(Unexplained, OneUnitOfFive_IsThatUnits) {
    const std::vector<FleetResult> results{left_with("P-1", 1.0, "no-gap"),
                                           left_with("P-2", 1.0, "explained"),
                                           left_with("P-3", 4.0, "partly-explained"),
                                           left_with("P-4", 1.0, "no-gap"), left_with("P-5", 1.0, "no-gap")};
    const std::vector<UnitHistory> units = histories(results);
    const Unexplained unexplained = unexplained_of(results, units);
    ASSERT_EQ(unexplained.units.size(), 1U);
    EXPECT_FALSE(unexplained.is_of_all());
    EXPECT_EQ(unexplained_title(unexplained, units), "Unit P-3: a gap that nothing known explains");
    EXPECT_EQ(unexplained_sentence(unexplained),
              "1 of 5 units has a gap of 4.00 floors that nothing known explains.");
}

TEST(Unexplained, EverythingExplained_IsNothing) {
    const Collected collected{{left_with("P-1", 1.0, "no-gap"), left_with("P-2", 1.05, "explained")}, {}};
    const FleetFindings findings = findings_of(collected.results);
    EXPECT_TRUE(findings.unexplained.empty());
    EXPECT_THAT(headline(fleet_page("fleet", collected, findings, {})),
                HasSubstr("No unit stands out, and none has changed."));
}

TEST(Unexplained, UnitsThatCouldNotBeDiagnosed_AreSaid_AndKeepWhatWasLeftBefore) {
    FleetResult before = left_with("P-1", 9.0), failed = left_with("P-1", 1.0, "");
    before.recorded_at_s = 1'772'409'600;
    failed.recorded_at_s = 1'773'014'400;
    failed.done = false;
    failed.reason = "stage0.csv: line 7: is cut off";
    const Collected collected{{before, failed, left_with("P-2", 1.0, "no-gap")}, {}};
    const FleetFindings findings = findings_of(collected.results);
    ASSERT_EQ(findings.unexplained.units.size(), 1U);
    EXPECT_EQ(not_diagnosed_sentence(findings.unexplained, findings.units),
              "1 of 2 units could not be diagnosed when it was recorded last: P-1.");
    EXPECT_THAT(headline(fleet_page("fleet", collected, findings, {})), HasSubstr("could not be diagnosed"));

    const Collected none{{failed}, {}};
    const std::string page = fleet_page("fleet", none, findings_of(none.results), {});
    EXPECT_THAT(headline(page), HasSubstr("1 of 1 units could not be diagnosed"));
    EXPECT_THAT(headline(page), Not(HasSubstr("No unit stands out")));
    EXPECT_THAT(page, Not(HasSubstr("Nothing. Go on")));
}

TEST(Unexplained, EffectThatTheCatalogueLacks_IsSaidToBeNamed) {
    FleetResult result = left_with("P-1", 1.0, "explained");
    result.effects.push_back({.effect = "air_drag",
                              .block = "macro.friction",
                              .probability = 0.9,
                              .gap_removed = 0.99,
                              .parameters = {},
                              .indistinguishable_from = {}});
    const Collected collected{{result, left_with("P-2", 1.0, "no-gap")}, {}};
    const std::vector<std::string> lines = named_but_not_judged(collected.results);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_THAT(lines.front(), HasSubstr("air_drag: named in 1 unit;"));
    EXPECT_THAT(fleet_page("fleet", collected, findings_of(collected.results), {}),
                HasSubstr("air_drag: named in 1 unit"));
}

TEST(Unexplained, LaterDiagnosisThatIsExplained_Counts) {
    FleetResult before = left_with("P-1", 9.0), after = left_with("P-1", 1.0, "explained");
    before.recorded_at_s = 1'772'409'600;
    after.recorded_at_s = 1'773'014'400;
    const std::vector<FleetResult> results{before, after};
    EXPECT_TRUE(unexplained_of(results, histories(results)).empty());
}

}  // namespace
}  // namespace fidservo::fleet
