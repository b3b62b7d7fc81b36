// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/journal.h"

#include "core/input_error.h"
#include "src/files/disk/sha256.h"

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace fidservo::inspect {
namespace {

using testing::HasSubstr;

class JournalTest : public testing::Test {
  protected:
    JournalTest()
        : folder_(std::filesystem::temp_directory_path() /
                  ("fidservo-journal-" + std::to_string(::getpid()))) {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    ~JournalTest() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path file() const { return folder_ / "journal.jsonl"; }
    std::string text() const {
        std::ostringstream content;
        content << std::ifstream(file(), std::ios::binary).rdbuf();
        return content.str();
    }
    void rewrite(const std::string& text) const { std::ofstream(file(), std::ios::binary) << text; }

    std::filesystem::path folder_;
};

RunIdentity identity() {
    return {"recipe", "rig", "plate", "printed", "calibration", 7, "sim", "sim", "0.1.0"};
}

Visit visit(int site) {
    Visit v{};
    v.site = site;
    v.end = Visit::End::measured;
    v.failures = {{"left", "no_tag", "no fiducial in the image"}};
    v.rows = {{site, "left", "mark_diameter", "dot", 0.1 + 0.2, "um", std::nullopt, 300.0, 10.0,
               Outcome::fail, "\xC2\xB5 \"x\"", "i.png"}};
    v.views = {{"left",
                "i.png",
                1.0 / 3.0,
                0.0,
                {{Overlay::Kind::defect, Outcome::fail, true, {{1.5, 2.5}}, "scratch"}}}};
    v.from_s = 1.25;
    v.to_s = 2.0;
    return v;
}

TEST_F(JournalTest, Resume_GivesBackWhatWasWritten) {
    {
        Journal journal(file(), identity());
        journal.homed("{\"state\": 1}");
        journal.ended(visit(5), "{\"state\": 2}");
    }
    const auto [journal, content] = Journal::resume(file(), identity());
    ASSERT_EQ(content.visits.size(), 1u);
    EXPECT_EQ(content.checkpoint, "{\"state\": 2}");
    EXPECT_EQ(content.resumed, 1);
    EXPECT_EQ(results_csv(content.visits), results_csv({visit(5)}));
    EXPECT_EQ(content.visits[0].rows[0].value, 0.1 + 0.2);
    EXPECT_EQ(content.visits[0].views[0].axis_x_mm, 1.0 / 3.0);
    EXPECT_EQ(content.visits[0].views[0].overlays[0].label, "scratch");
    EXPECT_EQ(content.visits[0].failures[0].reason, "no_tag");
}

TEST_F(JournalTest, CutShortAnywhere_TheWholeLinesCountAndTheRunGoesOn) {
    Journal written(file(), identity());
    written.homed("a");
    const std::size_t first = text().size();
    written.ended(visit(5), "b");
    const std::size_t second = text().size();
    written.ended(visit(6), "c");
    const std::string all = text();
    for (std::size_t length = first; length < all.size(); length += 41) {
        rewrite(all.substr(0, length));
        auto [journal, content] = Journal::resume(file(), identity());
        ASSERT_EQ(content.visits.size(), length < second ? 0u : 1u) << length;
        ASSERT_EQ(content.checkpoint, length < second ? "a" : "b") << length;
        journal.ended(visit(9), "d");
        const auto [again, later] = Journal::resume(file(), identity());
        ASSERT_EQ(later.visits.back().site, 9) << length;
    }
}

TEST_F(JournalTest, AnotherRecipe_IsRefused) {
    Journal(file(), identity()).homed("a");
    RunIdentity other = identity();
    other.recipe_sha256 = "changed";
    try {
        (void)Journal::resume(file(), other);
        FAIL() << "resumed with another recipe";
    } catch (const InputError& problem) {
        EXPECT_THAT(problem.what(), HasSubstr("the recipe has changed"));
    }
}

TEST_F(JournalTest, AnotherSeed_IsRefused) {
    Journal(file(), identity()).homed("a");
    RunIdentity other = identity();
    other.seed = 8;
    EXPECT_THROW((void)Journal::resume(file(), other), InputError);
}

TEST_F(JournalTest, NoJournalOrGarbage_IsRefused) {
    EXPECT_THROW((void)Journal::resume(file(), identity()), InputError);
    rewrite("this is not JSON\n");
    EXPECT_THROW((void)Journal::resume(file(), identity()), InputError);
    rewrite("");
    EXPECT_THROW((void)Journal::resume(file(), identity()), InputError);
}

TEST_F(JournalTest, KilledBeforeTheFirstLine_TheRunBeginsInItsFolder) {
    EXPECT_TRUE(killed_before_it_began(file()));
    rewrite("{\"event\":\"begun\",\"for");
    EXPECT_TRUE(killed_before_it_began(file()));
    rewrite("{\"event\":\"begun\"}\n");
    EXPECT_FALSE(killed_before_it_began(file()));
}

TEST_F(JournalTest, FolderOfSomethingElse_IsNotARunThatNeverBegan) {
    std::ofstream(file().parent_path() / "thesis.tex") << "precious";
    EXPECT_FALSE(killed_before_it_began(file()));
    EXPECT_FALSE(killed_before_it_began(file().parent_path() / "absent/journal.jsonl"));
}

TEST(Journal, DiskFull_IsARunFault) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    EXPECT_THROW(Journal("/dev/full", identity()), RunFault);
}

TEST(Sha256, KnownText_KnownFingerprint) {
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace fidservo::inspect
