// SPDX-License-Identifier: GPL-3.0-or-later
// The demo, whole, on the simulated rig: what it finds, and that a killed run ends like one that was not.
#include "core/rig.h"
#include "src/files/rig/rig_file.h"
#include "src/inspect/inspection_run.h"
#include "src/inspect/journal.h"

#include <csignal>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fidservo::inspect {
namespace {

namespace fs = std::filesystem;

std::string without_site(int site, const std::string& csv) {
    std::istringstream lines(csv);
    std::string kept;
    for (std::string line; std::getline(lines, line);)
        if (!line.starts_with(fmt::format("{},", site))) kept += line + '\n';
    return kept;
}

InspectionOptions demo(const fs::path& out) {
    InspectionOptions options;
    options.recipe = fs::path(FIDSERVO_ASSETS_DIR) / "demo/recipe.yaml";
    options.session.rig_file = fs::path(FIDSERVO_ASSETS_DIR) / "rig.yaml";
    options.out = out;
    return options;
}

std::string text_of(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

std::size_t visits_in(const fs::path& journal) {
    const std::string text = text_of(journal);
    std::size_t visits = 0;
    for (std::size_t at = 0; (at = text.find("\"event\":\"visit\"", at)) != std::string::npos; ++at) ++visits;
    return visits;
}

class SlowDemo : public testing::Test {
  protected:
    SlowDemo() : folder_(fs::temp_directory_path() / ("fidservo-demo-" + std::to_string(::getpid()))) {
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    ~SlowDemo() override { fs::remove_all(folder_); }
    fs::path folder_;
};

TEST_F(SlowDemo, KnownDefects_AllAreFoundAndNothingElse) {
    const Counts counts = run_inspection(demo(folder_ / "run"));
    EXPECT_EQ(counts.not_decidable, 0);
    EXPECT_EQ(counts.not_measured, 0);
    std::map<int, std::set<std::string>> failed;
    std::istringstream rows(text_of(folder_ / "run/results.csv"));
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
    const Counts at_first = run_inspection(demo(folder_ / "run"));
    InspectionOptions again = demo(folder_ / "again");
    again.session.camera = "images:" + (folder_ / "run").string();
    const Counts counts = run_inspection(again);
    EXPECT_EQ(counts.fail, at_first.fail);
    EXPECT_EQ(text_of(again.out / "results.csv"), text_of(folder_ / "run/results.csv"));
    EXPECT_FALSE(fs::exists(again.out / "recordings")) << "nothing moved";

    fs::remove(folder_ / "run/images/site-041-left.png");
    again.out = folder_ / "incomplete";
    const Counts incomplete = run_inspection(again);
    EXPECT_GT(incomplete.not_measured, 0);
    const std::string results = text_of(again.out / "results.csv");
    EXPECT_NE(results.find("no_image: no image site-041-left"), std::string::npos);
    EXPECT_EQ(without_site(41, results), without_site(41, text_of(folder_ / "run/results.csv")));
}

TEST_F(SlowDemo, KilledTwiceAndResumed_ResultsAreByteForByteTheSame) {
    InspectionOptions options = demo(folder_ / "killed");
    const fs::path journal = options.out / "journal.jsonl";
    for (const std::size_t after : {2u, 9u}) {
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            run_inspection(options);
            ::_exit(0);
        }
        int status = 0;
        while (visits_in(journal) < after && ::waitpid(child, &status, WNOHANG) == 0) ::usleep(20000);
        ::usleep(150000);  // somewhere within the next site
        ::kill(child, SIGKILL);
        ::waitpid(child, &status, 0);
        ASSERT_TRUE(WIFSIGNALED(status)) << "the run was over before it could be killed";
        options.resume = true;
    }
    run_inspection(options);
    run_inspection(demo(folder_ / "whole"));
    EXPECT_EQ(text_of(options.out / "results.csv"), text_of(folder_ / "whole/results.csv"));
    EXPECT_NE(text_of(options.out / "run.json").find("\"resumed\": 2"), std::string::npos);
    int set_aside = 0;
    for (const auto& entry : fs::directory_iterator(options.out / "recordings"))
        set_aside += entry.path().filename().string().find("interrupted") != std::string::npos;
    EXPECT_GE(set_aside, 1) << "what was recorded of the interrupted sites is kept";
}

}  // namespace
}  // namespace fidservo::inspect
