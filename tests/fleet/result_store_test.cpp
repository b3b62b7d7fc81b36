// SPDX-License-Identifier: GPL-3.0-or-later
// A result appears whole, once.
#include "src/fleet/result_store.h"

#include "core/failure.h"
#include "core/input_error.h"
#include "tests/src/temporary_folder.h"

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fidservo::fleet {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryFolder;
using testing::text_of;

const ResultName one{"unit-1", std::string(64, 'a')}, another{"unit-1", std::string(64, 'b')};

std::set<std::string> files_in(const std::filesystem::path& folder) {
    std::set<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        files.insert(entry.path().filename().string());
    return files;
}

TEST(ResultStore, Result_IsThereUnderItsNameAndNothingElse) {
    const TemporaryFolder folder;
    const ResultStore store(folder / "fleet");
    EXPECT_FALSE(store.find(one));
    store.publish(one, "text");
    EXPECT_EQ(one.file(), "unit-1-aaaaaaaaaaaaaaaa.json");
    EXPECT_EQ(store.find(one), "text");
    EXPECT_EQ(files_in(folder / "fleet/results"), std::set<std::string>{one.file()});
}

TEST(ResultStore, SecondWriter_MayBringTheSameBytesOnly) {
    const TemporaryFolder folder;
    const ResultStore store(folder / "fleet"), other(folder / "fleet");
    store.publish(one, "text");
    EXPECT_NO_THROW(other.publish(one, "text"));
    try {
        other.publish(one, "other text");
        FAIL() << "nothing was said";
    } catch (const RunFault& fault) {
        EXPECT_THAT(fault.what(), HasSubstr(one.file() + ": is there with other bytes"));
    }
    EXPECT_EQ(store.find(one), "text");
    EXPECT_EQ(files_in(folder / "fleet/results").size(), 1U);
}

TEST(ResultStore, ManyWritersAtOnce_LeaveOneWholeResult) {
    const TemporaryFolder folder;
    const std::string text(1 << 20, 'x');
    std::vector<pid_t> writers;
    for (int k = 0; k < 8; ++k) {
        const pid_t writer = ::fork();
        if (writer == 0) {
            try {
                ResultStore(folder / "fleet").publish(one, text);
                ::_exit(0);
            } catch (...) {
                ::_exit(1);
            }
        }
        writers.push_back(writer);
    }
    for (const pid_t writer : writers) {
        int status = 0;
        ::waitpid(writer, &status, 0);
        EXPECT_EQ(status, 0);
    }
    EXPECT_EQ(text_of(folder / "fleet/results" / one.file()), text);
    EXPECT_EQ(files_in(folder / "fleet/results").size(), 1U);
}

TEST(ResultStore, OtherInputsOfATask_SupersedeItsResultAndTakeItBack) {
    const TemporaryFolder folder;
    const auto results = folder / "fleet/results";
    ResultStore(folder / "fleet").publish(one, "old");
    ResultStore(folder / "fleet").publish(another, "new");
    EXPECT_EQ(files_in(results), std::set<std::string>{another.file()});
    EXPECT_EQ(text_of(folder / "fleet/superseded" / one.file()), "old");
    EXPECT_EQ(ResultStore(folder / "fleet").find(one), "old");
    EXPECT_EQ(files_in(results), std::set<std::string>{one.file()});
    EXPECT_EQ(text_of(folder / "fleet/superseded" / another.file()), "new");
}

TEST(ResultStore, Sweep_LeavesTheDraftsOfWritersAtWork) {
    const TemporaryFolder folder;
    const ResultStore store(folder / "fleet");
    store.publish(one, "text");
    const auto results = folder / "fleet/results";
    const std::string killed = "." + one.file() + ".0123456789abcdef-17.part",
                      at_work = "." + another.file() + ".0123456789abcdef-18.part";
    folder.write("fleet/results/" + killed, "te");
    folder.write("fleet/results/" + at_work, "te");
    folder.write("fleet/results/notes.txt", "mine");
    store.sweep();
    EXPECT_EQ(files_in(results), (std::set<std::string>{one.file(), at_work, "notes.txt"}));
}

TEST(ResultStore, FileInThePlaceOfTheFolder_IsOneLine) {
    const TemporaryFolder folder;
    folder.write("fleet", "a file");
    EXPECT_THROW(ResultStore(folder / "fleet"), InputError);
}

}  // namespace
}  // namespace fidservo::fleet
