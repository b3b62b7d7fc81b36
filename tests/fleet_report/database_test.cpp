// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/database.h"

#include "core/input_error.h"
#include "src/fleet/report/findings.h"
#include "src/fleet/report/fleet_json.h"
#include "src/fleet/report/fleet_page.h"
#include "tests/fleet_report/drawn_fleet.h"
#include "tests/src/temporary_folder.h"

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fidservo::fleet {
namespace {

class FleetFolder : public ::testing::Test {
  protected:
    void SetUp() override {
        std::filesystem::create_directories(fleet() / "results");
        DrawnFleet drawn;
        drawn.seed = 5;
        drawn.units = 6;
        drawn.weeks = 6;
        drawn.truth = [](std::size_t effect, std::size_t unit, std::size_t) {
            return effect == 0 ? 3.0 : effect == 1 && unit == 2 ? 12.0 : 0.0;
        };
        for (const FleetResult& result : draw(drawn)) write(result.file, file_text(result));
    }
    std::filesystem::path fleet() const { return folder_.path() / "fleet"; }
    void write(const std::string& file, const std::string& text) const {
        std::ofstream(fleet() / "results" / file) << text;
    }

  private:
    fidservo::testing::TemporaryFolder folder_;
};

TEST_F(FleetFolder, CollectedAgain_ChangesNothing) {
    const Collected first = collect_results(fleet()), second = collect_results(fleet());
    EXPECT_EQ(first.added, 36U);
    EXPECT_EQ(second.added, 0U);
    EXPECT_EQ(second.removed, 0U);
    const FleetFindings findings = findings_of(first.results);
    EXPECT_EQ(fleet_json(first, findings, {}), fleet_json(second, findings_of(second.results), {}));
}

TEST_F(FleetFolder, ResultsComeBackAsTheyWere) {
    const Collected collected = collect_results(fleet());
    ASSERT_EQ(collected.results.size(), 36U);
    const FleetResult& result = collected.results[2];
    EXPECT_EQ(result.unit, "P-0001");
    EXPECT_EQ(result.labels.at("batch"), "1");
    ASSERT_FALSE(result.effects.empty());
    EXPECT_EQ(result.effects[0].effect, "drive_gain");
    EXPECT_NEAR(result.effects[0].parameters.at(0).value, 1.0 + 3.0 * 0.004, 0.006);
}

TEST_F(FleetFolder, DamagedAndForeignFiles_AreNamedAndTheRestGoesOn) {
    write("cut.json", R"({"format": "fidservo-fleet-result/1", "task": {"ki)");
    write("other.json", R"({"format": "something-else/1"})");
    const Collected collected = collect_results(fleet());
    EXPECT_EQ(collected.results.size(), 36U);
    ASSERT_EQ(collected.damaged.size(), 2U);
    EXPECT_EQ(collected.damaged[0], "cut.json: is no whole JSON file");
    EXPECT_EQ(collected.damaged[1],
              "other.json: format: is 'something-else/1'; allowed: fidservo-fleet-result/1");
}

TEST_F(FleetFolder, FolderAndNumbersThatNoRigHas_AreNamedAndTheRestGoesOn) {
    std::filesystem::create_directories(fleet() / "results" / "folder.json");
    DrawnFleet one;
    one.units = one.weeks = 1;
    one.truth = [](std::size_t, std::size_t, std::size_t) { return 3.0; };
    FleetResult result = draw(one).front();
    result.effects.front().parameters.front().value = 1e300;
    write("huge.json", file_text(result));
    result = draw(one).front();
    result.effects.front().parameters.front().std = -1.0;
    write("negative.json", file_text(result));
    const Collected collected = collect_results(fleet());
    EXPECT_EQ(collected.results.size(), 36U);
    ASSERT_EQ(collected.damaged.size(), 3U);
    EXPECT_EQ(collected.damaged[0], "folder.json: is no file");
    EXPECT_NE(collected.damaged[1].find("allowed: a number up to 1e+12"), std::string::npos);
    EXPECT_NE(collected.damaged[2].find("std: is -1; allowed: 0 or more"), std::string::npos);
}

/// Recordings that show nothing of an effect say nothing of it, whatever their number.
TEST_F(FleetFolder, CampaignsThatWouldNotShowAnEffect_DoNotHideIt) {
    const double size = findings_of(collect_results(fleet()).results).judgements.front().size.value;
    DrawnFleet blind;
    blind.units = 6;
    blind.weeks = 6;
    blind.spread_floors = blind.std_floors = blind.scatter_floors = 0.0;
    for (FleetResult result : draw(blind)) {
        result.file = "rest-" + result.file;
        result.campaign_content[0] = 'f';
        *result.recorded_at_s += 86'400;
        for (TriedAlone& tried : result.tried) tried.would_show = false;
        write(result.file, file_text(result));
    }
    const FleetFindings findings = findings_of(collect_results(fleet()).results);
    ASSERT_FALSE(findings.judgements.empty());
    EXPECT_EQ(findings.judgements.front().whose, Whose::all);
    EXPECT_DOUBLE_EQ(findings.judgements.front().size.value, size);
}

TEST_F(FleetFolder, OneCampaignUnderTwoPaths_CountsOnce) {
    const double std = findings_of(collect_results(fleet()).results).judgements.front().size.std;
    for (const FleetResult& known : collect_results(fleet()).results) {
        FleetResult again = known;
        again.file = "again-" + known.file;
        again.campaign = "link/" + known.campaign;
        again.tried = {};
        write(again.file, file_text(again));
    }
    const Collected collected = collect_results(fleet());
    EXPECT_EQ(collected.results.size(), 72U);
    EXPECT_DOUBLE_EQ(findings_of(collected.results).judgements.front().size.std, std);
}

TEST_F(FleetFolder, FileThatIsGone_IsRemoved) {
    (void)collect_results(fleet());
    std::filesystem::remove(fleet() / "results" / "u0000-w000.json");
    const Collected collected = collect_results(fleet());
    EXPECT_EQ(collected.removed, 1U);
    EXPECT_EQ(collected.results.size(), 35U);
}

TEST_F(FleetFolder, DatabaseOfAnotherProgram_IsLeftAlone) {
    std::ofstream(fleet() / "fleet.sqlite") << std::string(4096, 'x');
    EXPECT_THROW((void)collect_results(fleet()), InputError);
}

TEST(Fleet, NoFolder_IsSaid) {
    EXPECT_THROW((void)collect_results("no-such-fleet"), InputError);
}

TEST_F(FleetFolder, ModelAndUnit_AreJudged) {
    const Collected collected = collect_results(fleet());
    const FleetFindings findings = findings_of(collected.results);
    const auto json = nlohmann::json::parse(fleet_json(collected, findings, {}));
    ASSERT_GE(json["judgements"].size(), 2U);
    EXPECT_EQ(json["judgements"][0]["whose"], "all");
    EXPECT_EQ(json["judgements"][0]["effect"], "drive_gain");
    EXPECT_EQ(json["judgements"][1]["whose"], "unit");
    EXPECT_EQ(json["judgements"][1]["units"][0], "P-0003");
    const std::string page = fleet_page("fleet", collected, findings, {});
    EXPECT_NE(page.find("All of them: the model is wrong"), std::string::npos);
    EXPECT_NE(page.find("Unit P-0003"), std::string::npos);
}

}  // namespace
}  // namespace fidservo::fleet
