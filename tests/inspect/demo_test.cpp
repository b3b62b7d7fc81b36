// SPDX-License-Identifier: GPL-3.0-or-later
// The complete demo on the simulated rig: its findings, and that a killed and resumed run has the same result
// as an uninterrupted one.
#include "src/inspect/inspection_run.h"
#include "tests/control_guardian/child_process.h"
#include "tests/src/temporary_folder.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::inspect {
namespace {

namespace fs = std::filesystem;
using fidservo::testing::ChildProcess;
using fidservo::testing::TemporaryFolder;
using fidservo::testing::text_of;

/// The rows of some sites, with the heading.
std::string of_sites(const std::set<std::string>& sites, const std::string& csv) {
    std::istringstream lines(csv);
    std::string kept, line;
    std::getline(lines, kept);
    while (std::getline(lines, line))
        if (sites.contains(line.substr(0, line.find(',')))) kept += '\n' + line;
    return kept;
}

InspectionOptions demo(const fs::path& out) {
    InspectionOptions options;
    options.recipe = fs::path(FIDSERVO_ASSETS_DIR) / "demo/recipe.yaml";
    options.session.rig_file = fs::path(FIDSERVO_ASSETS_DIR) / "rig.yaml";
    options.out = out;
    return options;
}

std::size_t visits_in(const fs::path& journal) {
    const std::string text = text_of(journal);
    std::size_t visits = 0;
    for (std::size_t at = 0; (at = text.find("\"event\":\"visit\"", at)) != std::string::npos; ++at) ++visits;
    return visits;
}

/// One run that nothing happens to, for all cases.
class SlowDemo : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        counts_ = run_inspection(demo(whole()));
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static fs::path whole() { return *folder_ / "whole"; }

    static inline std::unique_ptr<TemporaryFolder> folder_;
    static inline Counts counts_;
};

TEST_F(SlowDemo, KnownDefects_AllAreFoundAndNothingElse) {
    EXPECT_EQ(counts_.not_decidable, 0);
    EXPECT_EQ(counts_.not_measured, 0);
    std::map<int, std::set<std::string>> failed;
    std::istringstream rows(text_of(whole() / "results.csv"));
    for (std::string row; std::getline(rows, row);) {
        if (row.find(",fail,") == std::string::npos) continue;
        std::istringstream fields(row);
        std::string site, view, check;
        std::getline(fields, site, ',');
        std::getline(fields, view, ',');
        std::getline(fields, check, ',');
        failed[std::stoi(site)].insert(check);
    }
    using Checks = std::set<std::string>;
    const std::map<int, Checks> expected{{23, {"mark", "reference"}},
                                         {41, {"mark_centre_x", "mark_centre_y", "reference"}},
                                         {59, {"reference"}},
                                         {77, {"line_width", "line_narrowest", "reference"}}};
    EXPECT_EQ(failed, expected);
}

TEST_F(SlowDemo, ImagesMeasuredAgain_SameRecipeGivesTheSameResults) {
    const fs::path kept = *folder_ / "kept";
    fs::create_directory(kept);
    fs::copy(whole() / "images", kept / "images", fs::copy_options::recursive);
    InspectionOptions again = demo(*folder_ / "again");
    again.session.camera = "images:" + kept.string();
    const Counts counts = run_inspection(again);
    EXPECT_EQ(counts.fail, counts_.fail);
    EXPECT_EQ(text_of(again.out / "results.csv"), text_of(whole() / "results.csv"));
    EXPECT_FALSE(fs::exists(again.out / "recordings")) << "nothing moved";

    // An image is missing, among those of three sites.
    fs::remove(kept / "images/site-041-left.png");
    fs::copy(fs::path(FIDSERVO_ASSETS_DIR) / "demo", kept / "recipe", fs::copy_options::recursive);
    std::string recipe = text_of(again.recipe);
    const std::string all = "{ first: 5, step: 6, count: 16 }";
    ASSERT_NE(recipe.find(all), std::string::npos);
    recipe.replace(recipe.find(all), all.size(), "[35, 41, 47]");
    std::ofstream(kept / "recipe/recipe.yaml") << recipe;
    again.recipe = kept / "recipe/recipe.yaml";
    again.out = *folder_ / "incomplete";
    const Counts incomplete = run_inspection(again);
    EXPECT_GT(incomplete.not_measured, 0);
    const std::string results = text_of(again.out / "results.csv");
    EXPECT_NE(results.find("no_image: no image site-041-left"), std::string::npos);
    EXPECT_EQ(of_sites({"35", "47"}, results), of_sites({"35", "47"}, text_of(whole() / "results.csv")));
}

TEST_F(SlowDemo, KilledTwiceAndResumed_ResultsAreByteForByteTheSame) {
    InspectionOptions options = demo(*folder_ / "killed");
    const fs::path journal = options.out / "journal.jsonl";
    const std::string killed = options.out.string();
    for (const std::size_t after : {2u, 9u}) {
        std::vector<std::string> command{FIDSERVO_PROGRAM,
                                         "inspect",
                                         options.recipe.string(),
                                         "--rig",
                                         options.session.rig_file.string(),
                                         "--no-diagnosis",
                                         "--out",
                                         killed};
        if (options.resume) command.emplace_back("--resume");
        ChildProcess run(command);
        while (visits_in(journal) < after)
            if (run.output_ends(std::chrono::milliseconds(20))) break;
        run.output_ends(std::chrono::milliseconds(150));  // somewhere within the next site
        run.send(SIGKILL);
        ASSERT_EQ(run.wait(), -SIGKILL) << "the run was over before it could be killed";
        options.resume = true;
    }
    run_inspection(options);
    EXPECT_EQ(text_of(options.out / "results.csv"), text_of(whole() / "results.csv"));
    EXPECT_NE(text_of(options.out / "run.json").find("\"resumed\": 2"), std::string::npos);
    int set_aside = 0;
    for (const auto& entry : fs::directory_iterator(options.out / "recordings"))
        set_aside += entry.path().filename().string().find("interrupted") != std::string::npos;
    EXPECT_GE(set_aside, 1) << "what was recorded of the interrupted sites is kept";
}

}  // namespace
}  // namespace fidservo::inspect
