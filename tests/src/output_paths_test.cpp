// SPDX-License-Identifier: GPL-3.0-or-later
// Names under which what an interrupted run left is kept.
#include "src/files/disk/output_paths.h"

#include "tests/src/message_of.h"
#include "tests/src/run_program.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using std::filesystem::exists;

TEST(SetAside, FolderWithADotInItsName_KeepsTheWholeName) {
    const testing::TemporaryFolder folder;
    for (int times = 0; times < 2; ++times) {
        std::filesystem::create_directory(folder / "pulses-4.5");
        set_aside(folder / "pulses-4.5");
        EXPECT_FALSE(exists(folder / "pulses-4.5"));
    }
    EXPECT_TRUE(exists(folder / "pulses-4.5.interrupted-1"));
    EXPECT_TRUE(exists(folder / "pulses-4.5.interrupted-2"));
}

TEST(SetAside, File_KeepsItsExtension) {
    const testing::TemporaryFolder folder;
    folder.write("site.7.png", "");
    set_aside(folder / "site.7.png");
    EXPECT_TRUE(exists(folder / "site.7.interrupted-1.png"));
    set_aside(folder / "site.7.png");
    EXPECT_FALSE(exists(folder / "site.7.interrupted-2.png")) << "there was nothing to set aside";
}

TEST(DemandNewFolder, PossibleOne_LeavesNothing_ImpossibleOne_IsRefused) {
    const testing::TemporaryFolder folder;
    demand_new_folder(folder / "new");
    EXPECT_FALSE(exists(folder / "new"));
    folder.write("file", "");
    for (const char* name : {"file", "file/beneath"})
        EXPECT_NE(testing::message_of([&] {
                      demand_new_folder(folder / name);
                  }).find("--out: " + (folder / name).string() + ": "),
                  std::string::npos)
            << name;
}

/// Homing takes a rig half a minute, and moves it.
TEST(DemandNewFolder, CommandsThatRecord_RefuseBeforeAnythingMoves) {
    const testing::TemporaryFolder folder;
    folder.write("file", "");
    for (const std::vector<std::string>& command : {std::vector<std::string>{"record", "rest"},
                                                    {"record"},
                                                    {"record", "campaign"},
                                                    {"home"},
                                                    {"goto", "--tag", "5"}}) {
        std::vector<std::string> arguments = command;
        arguments.insert(arguments.end(), {"--out", "file/beneath"});
        const auto run = testing::run_program(arguments, folder.path());
        EXPECT_EQ(run.exit_code, 2) << run.err;
        EXPECT_EQ(run.err.find("fidservo: --out: file/beneath: cannot be made: "), 0u) << run.err;
    }
}

}  // namespace
}  // namespace fidservo
