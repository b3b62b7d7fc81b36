// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo fleet as its users run it.
#include "tests/control_guardian/child_process.h"
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fidservo {
namespace {

namespace fs = std::filesystem;

using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramRun;
using testing::run_program;
using testing::TemporaryFolder;
using testing::text_of;

/// Files of a folder by name.
std::map<std::string, std::string> texts_in(const fs::path& folder) {
    std::map<std::string, std::string> texts;
    for (const auto& entry : fs::directory_iterator(folder))
        texts[entry.path().filename().string()] = text_of(entry.path());
    return texts;
}

/// Two campaigns of two recordings each, and a folder without any.
void simulate_fleet(const fs::path& folder) {
    for (const std::string unit : {"unit-a", "unit-b"})
        for (const std::string experiment : {"rest", "macro-pulses"}) {
            const ProgramRun run =
                run_program({"simulate", experiment, "--effect", "stribeck_friction", "--seed", "3", "--unit",
                             unit, "--label", "batch=7", "--recorded-at", "2026-11-02T08:15:00Z", "--out",
                             fmt::format("recordings/{}/{}", unit, experiment)},
                            folder);
            ASSERT_EQ(run.exit_code, 0) << run.err;
        }
    fs::create_directories(folder / "recordings/unit-c");
}

ProgramRun diagnose(const fs::path& folder, const std::string& out,
                    const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"fleet",
                                   "diagnose",
                                   "recordings/unit-b",
                                   "recordings/unit-a",
                                   "recordings/unit-c",
                                   "--effects",
                                   "stribeck_friction,cable_force",
                                   "--out",
                                   out};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words, folder);
}

TEST(SlowFleet, Campaigns_HaveAResultEachThatSaysWhatItIsOf) {
    const TemporaryFolder folder;
    simulate_fleet(folder.path());
    const ProgramRun run = diagnose(folder.path(), "fleet");
    EXPECT_EQ(run.exit_code, 1) << run.err;
    EXPECT_THAT(run.out, HasSubstr("recordings/unit-c: failed: recordings/unit-c: holds no recording"));
    EXPECT_THAT(run.out, HasSubstr("3 campaigns: 2 done, 1 failed\n"));
    const auto results = texts_in(folder / "fleet/results");
    ASSERT_EQ(results.size(), 3U);
    auto result = nlohmann::json::parse(results.begin()->second);
    EXPECT_EQ(result["format"], "fidservo-fleet-result/1");
    EXPECT_EQ(result["status"], "done");
    EXPECT_EQ(result["task"]["campaign"], "recordings/unit-a");
    EXPECT_EQ(result["task"]["unit"], "unit-a");
    EXPECT_EQ(result["task"]["recorded_at"], "2026-11-02T08:15:00Z");
    EXPECT_EQ(result["task"]["labels"]["batch"], "7");
    EXPECT_EQ(result["diagnosis"]["effects"][0]["effect"], "stribeck_friction");
    for (const auto& [name, text] : results) EXPECT_THAT(text, Not(HasSubstr(folder.path().string())));
}

TEST(SlowFleet, SharesInAnyOrder_GiveTheSameBytesAndNothingIsDoneTwice) {
    const TemporaryFolder folder;
    simulate_fleet(folder.path());
    EXPECT_EQ(diagnose(folder.path(), "whole", {"--jobs", "2"}).exit_code, 1);
    for (const char* shard : {"3/3", "1/3", "2/3"})
        EXPECT_LE(diagnose(folder.path(), "shared", {"--shard", shard, "--jobs", "1"}).exit_code, 1);
    EXPECT_EQ(texts_in(folder / "whole/results"), texts_in(folder / "shared/results"));
    const ProgramRun again = diagnose(folder.path(), "shared", {"--resume"});
    EXPECT_EQ(again.exit_code, 1);
    EXPECT_THAT(again.out, HasSubstr("3 campaigns: 2 done (2 were), 1 failed (1 had)\n"));
}

TEST(SlowFleet, RecordingThatChanged_IsDiagnosedAgain) {
    const TemporaryFolder folder;
    simulate_fleet(folder.path());
    diagnose(folder.path(), "fleet");
    const auto before = texts_in(folder / "fleet/results");
    const auto yaml = folder / "recordings/unit-a/rest/recording.yaml";
    std::string text = text_of(yaml);
    text.replace(text.find("\"7\""), 3, "\"8\"");
    folder.write("recordings/unit-a/rest/recording.yaml", text);
    EXPECT_THAT(diagnose(folder.path(), "fleet").out, HasSubstr("2 done (1 were)"));
    const auto after = texts_in(folder / "fleet/results");
    EXPECT_EQ(after.size(), 3U);
    EXPECT_NE(after, before);
    EXPECT_EQ(texts_in(folder / "fleet/superseded").size(), 1U);
}

TEST(SlowFleet, Interrupted_EndsWithinASecondAndGoesOn) {
    const TemporaryFolder folder;
    simulate_fleet(folder.path());
    testing::ChildProcess child(
        {FIDSERVO_PROGRAM, "fleet", "diagnose", (folder / "recordings/unit-a").string(),
         (folder / "recordings/unit-b").string(), "--out", (folder / "fleet").string()});
    while (!fs::exists(folder / "fleet/results")) ::usleep(1000);
    ::usleep(300'000);
    child.send(SIGINT);
    const auto asked = std::chrono::steady_clock::now();
    EXPECT_EQ(child.wait(), 3);
    EXPECT_LT(std::chrono::steady_clock::now() - asked, std::chrono::seconds(1));
    for (const auto& [name, text] : texts_in(folder / "fleet/results"))
        EXPECT_TRUE(nlohmann::json::accept(text)) << name;
}

TEST(Fleet, Misuse_GetsOneLine) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "campaign");
    const auto complaint = [&](std::vector<std::string> words) {
        words.insert(words.begin(), "fleet");
        const ProgramRun run = run_program(words, folder.path());
        EXPECT_EQ(run.exit_code, 2);
        return run.err;
    };
    EXPECT_EQ(complaint({"diagnose", "absent", "--out", "fleet"}),
              "fidservo: absent: there is no such folder\n");
    EXPECT_EQ(complaint({"diagnose", "campaign", "--out", "fleet", "--shard", "0/4"}),
              "fidservo: --shard: 0/4: must be K/N, with K from 1 to N: 1/16 to 16/16\n");
    EXPECT_EQ(complaint({"diagnose", "campaign", "--out", "fleet", "--resume"}),
              "fidservo: --resume: fleet: there are no results to go on with; leave --resume out to begin\n");
    EXPECT_EQ(complaint({"diagnose", "campaign", "--out", "fleet", "--effects", "magic"}),
              "fidservo: --effects: magic: there is no such effect; fidservo simulate --help lists them\n");
    EXPECT_FALSE(fs::exists(folder / "fleet"));
    EXPECT_THAT(complaint({}), HasSubstr("fleet: what?"));
}

}  // namespace
}  // namespace fidservo
